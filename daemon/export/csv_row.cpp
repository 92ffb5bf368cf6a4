#include "daemon/export/csv_row.hpp"

#include <charconv>
#include <iterator>

namespace fvd {

CsvRow& CsvRow::number(double value, int decimals) {
  char text[64];
  const auto end = std::to_chars(std::begin(text), std::end(text), value, std::chars_format::fixed, decimals);
  return cell(end.ec == std::errc() ? std::string_view(text, static_cast<std::size_t>(end.ptr - text)) : "");
}

CsvRow& CsvRow::empty(int cells) {
  for (int i = 0; i < cells; ++i) cell("");
  return *this;
}

CsvRow& CsvRow::cell(std::string_view text) {
  if (!first_) out_ += ',';
  first_ = false;
  out_ += text;
  return *this;
}

}  // namespace fvd
