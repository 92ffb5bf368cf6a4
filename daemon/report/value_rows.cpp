#include "daemon/report/value_rows.hpp"

#include <algorithm>
#include <array>
#include <locale>
#include <sstream>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/result/value_digits.hpp"

namespace fvd {

namespace {

std::string plain_text(double number) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << number;
  return text.str();
}

std::string limits_text(const Limits& limits) {
  if (limits.lower && limits.upper) return plain_text(*limits.lower) + " … " + plain_text(*limits.upper);
  if (limits.lower) return "≥ " + plain_text(*limits.lower);
  return limits.upper ? "≤ " + plain_text(*limits.upper) : std::string();
}

std::string without_unit(const std::string& key) {
  constexpr std::array<std::string_view, 4> kSuffixes{"_um", "_percent", "_deg", "_um2"};
  for (const std::string_view suffix : kSuffixes) {
    if (key.size() > suffix.size() && key.ends_with(suffix)) return key.substr(0, key.size() - suffix.size());
  }
  return key;
}

/// " (0.08 mm x 5)" of a profile's R values, empty for all others: a bare Ra means the default settings.
std::string settings_suffix(const EvaluatedMeasurement& made, const std::string& key) {
  if (made.kind != "profile" || key.starts_with('P')) return {};
  const auto details = nlohmann::json::parse(made.details, nullptr, false);
  if (!details.is_object()) return {};
  const auto suffix = details.find("label_suffix");
  return suffix != details.end() && suffix->is_string() ? suffix->get<std::string>() : std::string();
}

ValueRow row_of(const std::string& name, const EvaluatedValue& value) {
  ValueRow row;
  row.name = name;
  row.unit = unit_text(value.unit);
  row.verdict = value.verdict;
  if (value.limits) row.limits = limits_text(*value.limits);
  row.value = row.uncertainty = "-";
  if (!value.value) {
    row.reason = with_micro_sign(value.reason);
    return row;
  }
  const int digits = digits_behind_point(name, value);
  row.value = fixed_digits(*value.value, digits);
  if (value.expanded_u) row.uncertainty = fixed_digits(*value.expanded_u, digits);
  if (value.expanded_u && value.k) row.uncertainty += "  (k " + fixed_digits(*value.k, 2) + ")";
  return row;
}

/// Keys in the order of their rows.
std::vector<std::string> ordered_keys(const EvaluatedMeasurement& made) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : made.values) keys.push_back(key);
  const auto rank = [&made](const std::string& key) {
    if (key == made.main_value) return 0;
    return made.values.at(key).limits ? 1 : 2;
  };
  std::stable_sort(keys.begin(), keys.end(),
                   [&rank](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  return keys;
}

void add_measurement(const std::string& name, const EvaluatedMeasurement& made, std::vector<ValueRow>& rows) {
  const std::size_t first = rows.size();
  for (const std::string& key : ordered_keys(made)) {
    rows.push_back(row_of(without_unit(key) + settings_suffix(made, key), made.values.at(key)));
  }
  if (rows.size() == first) {
    ValueRow row;
    row.value = row.uncertainty = "-";
    row.reason = with_micro_sign(made.reason);
    row.verdict = made.verdict;
    rows.push_back(std::move(row));
  }
  rows[first].measurement = name;
}

ValueRow row_of(const MeasuredValue& measured) {
  EvaluatedValue value;
  value.value = measured.value;
  value.unit = measured.unit;
  value.expanded_u = measured.expanded_u;
  value.k = measured.k;
  value.limits = measured.limits;
  value.verdict = measured.verdict;
  value.reason = "not one point is valid";
  return row_of(measured.name, value);
}

}  // namespace

std::string with_micro_sign(std::string text) {
  constexpr std::string_view kPlain = " um";
  constexpr std::string_view kShown = " µm";
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto goes_on = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  for (auto place = text.find(kPlain); place != std::string::npos; place = text.find(kPlain, place + 1)) {
    const std::size_t end = place + kPlain.size();
    if (place == 0 || !is_digit(text[place - 1]) || (end < text.size() && goes_on(text[end]))) continue;
    text.replace(place, kPlain.size(), kShown);
  }
  return text;
}

std::string unit_text(const std::string& unit) {
  if (unit == "1" || unit == "um/um") return {};
  if (unit == "deg") return "°";
  std::string text = unit;
  if (text.starts_with("um")) text.replace(0, 2, "µm");
  constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kPowers{{{"^2", "²"}, {"^3", "³"}}};
  for (const auto& [plain, raised] : kPowers) {
    if (const auto place = text.find(plain); place != std::string::npos) text.replace(place, plain.size(), raised);
  }
  return text;
}

std::vector<ValueRow> value_rows(const Result& result) {
  std::vector<ValueRow> rows;
  if (result.evaluation) {
    for (const std::string& name : result.evaluation->order) {
      const auto found = result.evaluation->measurements.find(name);
      if (found != result.evaluation->measurements.end()) add_measurement(name, found->second, rows);
    }
  }
  bool first = true;
  for (const MeasuredValue& measured : result.measurements) {
    if (result.evaluation && !measured.limits) continue;
    rows.push_back(row_of(measured));
    if (std::exchange(first, false)) rows.back().measurement = "map";
  }
  return rows;
}

}  // namespace fvd
