#pragma once

/// One line of a table.

#include <optional>
#include <string>
#include <string_view>

namespace fvd {

/// Appends cells to `out` with commas between them; the destructor ends the line with LF. context: one thread at a
/// time.
class CsvRow {
 public:
  explicit CsvRow(std::string& out) : out_(out) {}
  ~CsvRow() { out_ += '\n'; }
  CsvRow(const CsvRow&) = delete;
  CsvRow& operator=(const CsvRow&) = delete;

  /// decimals: enough that no digit of meaning is lost, few enough to be read.
  CsvRow& number(double value, int decimals);
  /// Empty where the value is unknown.
  CsvRow& number(const std::optional<double>& value, int decimals) {
    return value ? number(*value, decimals) : empty(1);
  }
  template <typename Integer>
  CsvRow& integer(Integer value) {
    return cell(std::to_string(value));
  }
  CsvRow& empty(int cells);
  /// A word without comma, quote and line end.
  CsvRow& word(std::string_view text) { return cell(text); }

 private:
  CsvRow& cell(std::string_view text);

  std::string& out_;
  bool first_ = true;
};

}  // namespace fvd
