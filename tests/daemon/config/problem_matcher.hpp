#pragma once

#include <string>

#include "config/problem.hpp"
#include "gmock/gmock.h"

namespace fvd::test {

/// Matches a problem of a configuration at a JSON pointer whose text has `says` in it.
inline auto problem(const std::string& pointer, const std::string& says = "") {
  using testing::Field;
  return testing::AllOf(Field("pointer", &Problem::pointer, pointer),
                        Field("message", &Problem::message, testing::HasSubstr(says)));
}

}  // namespace fvd::test
