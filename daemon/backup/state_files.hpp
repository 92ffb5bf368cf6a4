#pragma once

/// What a state folder has beside results.

#include <array>

namespace fvd {

inline constexpr const char* kDatabaseFile = "fvd.sqlite";
/// Copied as they are; files and folders.
inline constexpr std::array kStateFiles{"recipes", "calibration", "studies", "stage_history.json"};

}  // namespace fvd
