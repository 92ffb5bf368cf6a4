#pragma once

/// Verdicts as shapes that are told apart without colour. Only sources of this folder include it.

#include "core/surface/verdict.hpp"
#include "daemon/report/canvas.hpp"

namespace fvd {

/// Pass: a disc with a tick. Fail: a square with a cross. Uncertain: a diamond with a question mark. Invalid: an empty
/// square that is struck through. size: of the sign, in points.
void draw_verdict_sign(Canvas& canvas, PagePoint centre, double size, Verdict verdict);

[[nodiscard]] Colour verdict_ink(Verdict verdict);

/// "PASS" and so on.
[[nodiscard]] const char* verdict_word(Verdict verdict);

}  // namespace fvd
