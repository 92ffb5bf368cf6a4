#pragma once

/// In-process doubles of the hardware interfaces for fast, deterministic tests of the scan.
