#pragma once

/// Expectations about Error: its code, and what its message tells.

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fvd::test {

/// The code, and words that the message must contain.
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

/// The Error that `body` throws; nothing if it throws none.
template <typename Body>
std::optional<Error> error_of(Body body) {
  try {
    body();
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

inline std::string_view name_of(const std::optional<Error>& error) {
  return error ? error_name(error->code()) : std::string_view("no error");
}

}  // namespace fvd::test

#define FVD_EXPECT_ERROR_SAYING(expected_code, statement, matcher)                                  \
  do {                                                                                              \
    const auto fvd_error = ::fvd::test::error_of([&] { statement; });                               \
    EXPECT_EQ(::fvd::test::name_of(fvd_error), ::fvd::error_name(::fvd::ErrorCode::expected_code)); \
    EXPECT_THAT(std::string(fvd_error ? fvd_error->what() : ""), matcher);                          \
  } while (false)

#define FVD_EXPECT_ERROR(expected_code, statement) \
  FVD_EXPECT_ERROR_SAYING(expected_code, statement, ::testing::Not(::testing::IsEmpty()))
