#pragma once

/// Names of one skeleton as a table: a row per file, a column per number.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "drivers/replay/name_fields.hpp"

namespace fvd {

/// What a '-' and a '.' before digits mean is decided by all names together.
class NameColumns {
 public:
  /// names: file names with their extensions, at least one, whose stems have the same skeleton. Throws Error kBadInput
  /// with the choices if a '-' may be a sign or a separator, or a '.' a decimal point or a separator.
  explicit NameColumns(std::vector<std::string> names);

  [[nodiscard]] std::size_t rows() const { return names_.size(); }
  [[nodiscard]] const std::string& name(std::size_t row) const { return names_[row]; }
  [[nodiscard]] const NameNumber& at(std::size_t row, std::size_t column) const { return fields_[row].numbers[column]; }

  /// Columns whose numbers are not all equal.
  [[nodiscard]] std::vector<std::size_t> varying() const;
  [[nodiscard]] std::vector<std::size_t> sorted(std::size_t column) const;
  /// Whether no number occurs twice.
  [[nodiscard]] bool distinct(std::size_t column) const;
  /// Unit of length after the number, in um. None where an x or y stands before it: a position of the part.
  [[nodiscard]] std::optional<double> unit_um(std::size_t column) const;

  /// The first name with fields of --pattern, or '*', in the place of the numbers of these columns, and with '*' in the
  /// place of those of `any`.
  [[nodiscard]] std::string pattern(const std::vector<std::size_t>& columns, const std::string& field,
                                    const std::vector<std::size_t>& any = {}) const;

  /// Throws Error kBadInput: why, and a pattern for each of these columns that has a stack beside the first name.
  [[noreturn]] void ask(const std::string& why, const std::vector<std::size_t>& columns) const;

 private:
  /// Rows that are equal to the first in all columns but this.
  [[nodiscard]] std::size_t rows_beside_first(std::size_t column) const;
  void resolve_sign(std::size_t column);
  void resolve_point(std::size_t column);
  void separate_sign(std::size_t column);
  void separate_whole(std::size_t column);
  [[nodiscard]] bool after_letter(std::size_t column, char letter) const;
  template <typename Predicate>
  [[nodiscard]] bool all(std::size_t column, Predicate predicate) const;

  std::vector<std::string> names_;
  std::vector<NameFields> fields_;
};

/// Throws Error kBadInput: why, and the patterns to choose from.
[[noreturn]] void ask_for_pattern(const std::string& why, const std::vector<std::string>& patterns);

}  // namespace fvd
