#pragma once

/// Why a caller may not do what he asks for, whatever the machine could.

#include <stdexcept>
#include <string>

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

}  // namespace fvd
