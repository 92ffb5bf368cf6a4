#pragma once

/// What an exception of any kind says of itself.

#include <exception>
#include <string>

namespace fvd {

/// what() of a std::exception, else "unknown exception". failure is not null. context: thread-safe.
[[nodiscard]] std::string exception_text(const std::exception_ptr& failure);

}  // namespace fvd
