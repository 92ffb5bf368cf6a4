#pragma once

/// What a state folder has beside results.

#include <array>

namespace fvd {

inline constexpr const char* kDatabaseFile = "fvd.sqlite";
/// What is configured, as a backup has it.
inline constexpr const char* kConfigFile = "fvd.json";
inline constexpr const char* kConfigParts = "conf.d";
inline constexpr const char* kStageProfile = "stage_profile.json";
inline constexpr const char* kTokenFile = "tokens";
/// Copied as they are; files and folders.
inline constexpr std::array kStateFiles{"recipes", "calibration", "studies", "stage_history.json"};

}  // namespace fvd
