#pragma once

/// Exit codes of fvdctl, after sysexits.h.

#include "core/base/error.hpp"

namespace fvd::ctl {

inline constexpr int kExitOk = 0;
inline constexpr int kExitJobFailed = 1;         ///< the job failed or was aborted, or a device refused
inline constexpr int kExitVerdictFail = 2;       ///< `process`, `measure`: values are outside the recipe's limits
inline constexpr int kExitVerdictUncertain = 3;  ///< their uncertainty lets neither be stated
inline constexpr int kExitVerdictInvalid = 4;    ///< a value with limits could not be measured
inline constexpr int kExitUsage = 64;            ///< wrong arguments
inline constexpr int kExitBadData = 65;          ///< a file, parameter, job, recipe, address or token that cannot be
                                                 ///< used, or a role that may not
inline constexpr int kExitUnavailable =
    69;  ///< no daemon, camera or drive, no answer in time, or it takes no commands now
inline constexpr int kExitInternal = 70;  ///< a bug on either side
inline constexpr int kExitConfig = 78;    ///< `measure`, `stage stop`: recipe or configuration was refused
inline constexpr int kExitIo = 74;        ///< a file could not be read or written

/// The exit code for an Error of this code.
[[nodiscard]] int exit_code(ErrorCode code) noexcept;

/// The exit code for a JSON-RPC reply with this error code.
[[nodiscard]] int exit_code_of_rpc(int code) noexcept;

}  // namespace fvd::ctl
