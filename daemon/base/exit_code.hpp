#pragma once

/// Exit codes of fvd, after sysexits.h; systemd does not restart after kUsage and kConfig.

#include "core/base/error.hpp"

namespace fvd::exit_code {

inline constexpr int kOk = 0;
inline constexpr int kUsage = 64;        ///< wrong arguments
inline constexpr int kUnavailable = 69;  ///< a device or a port is missing
inline constexpr int kInternal = 70;     ///< a bug
inline constexpr int kIo = 74;           ///< database or files
inline constexpr int kConfig = 78;       ///< the configuration was refused

}  // namespace fvd::exit_code

namespace fvd {

/// With which code fvd ends when this error stops it.
[[nodiscard]] constexpr int exit_code_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kBadConfig:
    case ErrorCode::kBadInput:
      return exit_code::kConfig;
    case ErrorCode::kNotReady:
    case ErrorCode::kCameraDisconnected:
    case ErrorCode::kStageDisconnected:
      return exit_code::kUnavailable;
    case ErrorCode::kStorageFull:
    case ErrorCode::kStorageWrite:
    case ErrorCode::kDatabase:
    case ErrorCode::kBusy:  // another fvd has the database
      return exit_code::kIo;
    default:
      return exit_code::kInternal;
  }
}

}  // namespace fvd
