#pragma once

/// A file name as texts and the numbers between them.

#include <compare>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fvd {

/// A number as it is written in a name: "007", "-20", "0.5".
struct NameNumber {
  char sign = '\0';      ///< '-', '+', or none; a '-' may prove to be a separator, which only other names can tell
  std::string digits;    ///< before the decimal point, leading zeros included
  std::string fraction;  ///< after it; empty: a whole number

  [[nodiscard]] double value() const;
  [[nodiscard]] std::string text() const;
};

/// Exact for any number of digits; "07" equals "7", "0.50" equals "0.5", "-0" equals "0".
[[nodiscard]] std::weak_ordering compare(const NameNumber& a, const NameNumber& b);

/// texts has one element more than numbers: text, number, text, ..., text.
struct NameFields {
  std::vector<std::string> texts;
  std::vector<NameNumber> numbers;

  /// Equal for names that differ in their numbers only.
  [[nodiscard]] std::string skeleton() const;
  /// Letters of the texts in lower case, nothing else.
  [[nodiscard]] std::string words() const;
};

/// Splits a name without its extension. A '-' or '+' before a digit and not after one is a sign. Digits around one
/// point are a decimal number, digits around a comma only where a unit of length follows.
[[nodiscard]] NameFields name_fields(std::string_view stem);

/// The unit of length with which the text after a number begins ("um", "mm", "nm", after a blank or '_' too) in um.
[[nodiscard]] std::optional<double> leading_unit_um(std::string_view text);

[[nodiscard]] std::string lower_case(std::string_view text);

/// Of a file's name, one spelling for each kind: ".tif" of "a.TIFF", ".jpg" of "a.jpeg".
[[nodiscard]] std::string plain_extension(const std::string& filename);

}  // namespace fvd
