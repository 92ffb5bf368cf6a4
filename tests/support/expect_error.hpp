#pragma once

/// Checks for fvd::Error: the code, and words that the message must contain.

#include <initializer_list>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fvd::test {

template <typename Action>
void expect_error(ErrorCode code, std::initializer_list<std::string> words, Action&& action) {
  try {
    std::forward<Action>(action)();
    ADD_FAILURE() << "no error, expected " << error_name(code);
  } catch (const Error& error) {
    EXPECT_EQ(error_name(error.code()), error_name(code)) << error.what();
    for (const auto& word : words) EXPECT_THAT(error.what(), ::testing::HasSubstr(word));
  }
}

}  // namespace fvd::test
