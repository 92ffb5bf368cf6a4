#pragma once

/// Why a caller may not do what he asks for, whatever the machine could.

#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/error.hpp"

namespace fvd {

enum class AccessCode {
  kNotAllowed,  ///< his role may not do that
  kNoControl,   ///< another has control of the instrument
};

class AccessError : public std::runtime_error {
 public:
  AccessError(AccessCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] AccessCode code() const noexcept { return code_; }

 private:
  AccessCode code_;
};

/// The file of tokens cannot be used. The message is for callers, who may be strangers; the reason, with the file and
/// the place in it, is for the log alone, below the level of what is shown to viewers as an alarm.
class TokensUnreadable : public Error {
 public:
  explicit TokensUnreadable(std::string reason)
      : Error(ErrorCode::kBadConfig, "the file of tokens cannot be read; the log of fvd says why"),
        reason_(std::move(reason)) {}
  [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

 private:
  std::string reason_;
};

}  // namespace fvd
