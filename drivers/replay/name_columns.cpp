#include "drivers/replay/name_columns.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

#include "core/base/error.hpp"

namespace fvd {

namespace {

/// The field of --pattern for z in a unit.
std::string z_field(double unit_um) { return unit_um == 1e3 ? "{z_mm}" : unit_um == 1e-3 ? "{z_nm}" : "{z_um}"; }

bool is_zero(const NameNumber& number) { return compare(number, {'\0', "0", ""}) == 0; }

/// Names are rounded to their last digit.
bool evenly_spaced(std::vector<NameNumber> numbers) {
  std::sort(numbers.begin(), numbers.end(), [](const auto& a, const auto& b) { return compare(a, b) < 0; });
  if (numbers.size() < 3) return false;
  std::size_t places = 0;
  for (const NameNumber& number : numbers) places = std::max(places, number.fraction.size());
  const double mean = (numbers.back().value() - numbers.front().value()) / static_cast<double>(numbers.size() - 1);
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const double step = numbers[i].value() - numbers[i - 1].value();
    if (std::abs(step - mean) > 1.01 * std::pow(10.0, -static_cast<double>(places))) return false;
  }
  return true;
}

}  // namespace

void ask_for_pattern(const std::string& why, const std::vector<std::string>& patterns) {
  std::string message = why + ": say which with --pattern of fvdctl, or move the others away; for example";
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    message += (i == 0 ? " '" : i + 1 == patterns.size() ? " or '" : ", '") + patterns[i] + "'";
  }
  throw Error(ErrorCode::kBadInput, message);
}

NameColumns::NameColumns(std::vector<std::string> names) : names_(std::move(names)) {
  for (const std::string& name : names_) fields_.push_back(name_fields(std::filesystem::path(name).stem().string()));
  for (std::size_t column = 0; column < fields_.front().numbers.size(); ++column) {
    resolve_sign(column);
    resolve_point(column);
  }
}

template <typename Predicate>
bool NameColumns::all(std::size_t column, Predicate predicate) const {
  return std::all_of(fields_.begin(), fields_.end(),
                     [&](const NameFields& row) { return predicate(row.numbers[column]); });
}

std::vector<std::size_t> NameColumns::varying() const {
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < fields_.front().numbers.size(); ++column) {
    if (!all(column, [&](const NameNumber& n) { return compare(n, at(0, column)) == 0; })) columns.push_back(column);
  }
  return columns;
}

std::vector<std::size_t> NameColumns::sorted(std::size_t column) const {
  std::vector<std::size_t> order(rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return compare(at(a, column), at(b, column)) < 0; });
  return order;
}

bool NameColumns::distinct(std::size_t column) const {
  const auto order = sorted(column);
  return std::adjacent_find(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
           return compare(at(a, column), at(b, column)) == 0;
         }) == order.end();
}

bool NameColumns::after_letter(std::size_t column, char letter) const {
  std::string text = lower_case(fields_.front().texts[column]);
  while (!text.empty() && std::string_view("-_= ").find(text.back()) != std::string_view::npos) text.pop_back();
  if (text.empty() || text.back() != letter) return false;
  return text.size() == 1 || std::isalpha(static_cast<unsigned char>(text[text.size() - 2])) == 0;
}

std::optional<double> NameColumns::unit_um(std::size_t column) const {
  if (after_letter(column, 'x') || after_letter(column, 'y')) return std::nullopt;
  return leading_unit_um(fields_.front().texts[column + 1]);
}

std::string NameColumns::pattern(const std::vector<std::size_t>& columns, const std::string& field,
                                 const std::vector<std::size_t>& any) const {
  const NameFields& row = fields_.front();
  const auto among = [](const std::vector<std::size_t>& of, std::size_t column) {
    return std::find(of.begin(), of.end(), column) != of.end();
  };
  std::string result;
  for (std::size_t column = 0; column < row.numbers.size(); ++column) {
    const std::string other = among(any, column) ? "*" : row.numbers[column].text();
    result += row.texts[column] + (among(columns, column) ? field : other);
  }
  return result + row.texts.back() + std::filesystem::path(names_.front()).extension().string();
}

std::size_t NameColumns::rows_beside_first(std::size_t column) const {
  return static_cast<std::size_t>(std::count_if(fields_.begin(), fields_.end(), [&](const NameFields& row) {
    for (std::size_t other = 0; other < row.numbers.size(); ++other) {
      if (other != column && compare(row.numbers[other], at(0, other)) != 0) return false;
    }
    return true;
  }));
}

void NameColumns::ask(const std::string& why, const std::vector<std::size_t>& columns) const {
  constexpr std::size_t kLeastSlices = 3;  // a peak needs as many
  std::vector<std::string> patterns;
  std::vector<std::string> all;
  for (const std::size_t column : columns) {
    const std::optional<double> unit = unit_um(column);
    const std::string field = unit ? z_field(*unit) : "{n}";
    all.push_back(pattern({column}, field));
    if (rows_beside_first(column) >= kLeastSlices) {
      patterns.push_back(all.back());
    } else if (rows() >= kLeastSlices && distinct(column)) {  // whatever the others are
      patterns.push_back(pattern({column}, field, varying()));
    }
  }
  ask_for_pattern(why, patterns.empty() ? all : patterns);
}

void NameColumns::separate_sign(std::size_t column) {
  for (NameFields& row : fields_) {
    row.texts[column] += row.numbers[column].sign;
    row.numbers[column].sign = '\0';
  }
}

void NameColumns::resolve_sign(std::size_t column) {
  if (!all(column, [](const NameNumber& n) { return n.sign == '-'; })) return;
  const std::size_t digits = at(0, column).digits.size();
  const bool padded = all(column, [&](const NameNumber& n) { return n.digits.size() == digits; }) &&
                      !all(column, [](const NameNumber& n) { return !n.digits.starts_with('0'); });
  const bool zero = !all(column, [](const NameNumber& n) { return !is_zero(n); });  // nobody writes -0
  const bool constant = all(column, [&](const NameNumber& n) { return compare(n, at(0, column)) == 0; });
  const auto unit = leading_unit_um(fields_.front().texts[column + 1]);
  const bool means_z = unit || after_letter(column, 'z');
  if (constant || zero || !means_z || (padded && !unit)) return separate_sign(column);
  const std::string field = z_field(unit.value_or(1.0));
  const std::string as_sign = pattern({column}, field);
  separate_sign(column);
  ask_for_pattern("the '-' before the number of all names, such as " + names_.front() +
                      ", can be the sign of z or a separator, which turns the order round",
                  {as_sign, pattern({column}, unit ? field : "{n}")});
}

void NameColumns::separate_whole(std::size_t column) {
  for (NameFields& row : fields_) {
    NameNumber& number = row.numbers[column];
    row.texts[column] += (number.sign == '\0' ? "" : std::string(1, number.sign)) + number.digits + ".";
    number = {'\0', std::exchange(number.fraction, {}), {}};
  }
}

void NameColumns::resolve_point(std::size_t column) {
  if (unit_um(column) || !all(column, [](const NameNumber& n) { return !n.fraction.empty(); })) return;
  const auto integer = [](const NameNumber& n) { return NameNumber{'\0', n.digits, {}}; };
  const bool one_whole = all(column, [&](const NameNumber& n) {
    return n.sign == at(0, column).sign && compare(integer(n), integer(at(0, column))) == 0;
  });
  if (!one_whole) {
    std::vector<NameNumber> numbers;
    for (const NameFields& row : fields_) numbers.push_back(row.numbers[column]);
    if (after_letter(column, 'z') || evenly_spaced(numbers)) return;
    ask_for_pattern("the '.' in names such as " + names_.front() + " can be a decimal point or a separator",
                    {pattern({column}, "{z_um}"), pattern({column}, at(0, column).digits + ".{n}")});
  }
  const auto as_decimals = sorted(column);
  const bool distinct_decimals = distinct(column);
  const std::string decimal_pattern = pattern({column}, "{z_um}");
  separate_whole(column);
  if (!distinct_decimals || !distinct(column) || sorted(column) == as_decimals) return;
  ask_for_pattern("the '.' in names such as " + names_.front() + " can be a decimal point or a separator",
                  {decimal_pattern, pattern({column}, "{n}")});
}

}  // namespace fvd
