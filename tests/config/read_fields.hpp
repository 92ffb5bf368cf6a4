#pragma once

/// What a description makes of a document, for tests.

#include <string>

#include <gmock/gmock.h>

#include "config/field_reader.hpp"

namespace fvd::test {

/// The problems of reading the text into the structure by its describe(Fields&, Structure&).
template <typename Structure>
Problems read(const std::string& text, Structure& structure) {
  Problems problems;
  read_document(
      text, [&](Fields& fields) { describe(fields, structure); }, problems);
  return problems;
}

template <typename Structure>
Problems problems_of(const std::string& text) {
  Structure structure;
  return read(text, structure);
}

inline auto problem(const std::string& place, const std::string& part) {
  return ::testing::AllOf(::testing::Field(&Problem::pointer, place),
                          ::testing::Field(&Problem::message, ::testing::HasSubstr(part)));
}

}  // namespace fvd::test
