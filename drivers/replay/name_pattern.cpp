#include "drivers/replay/name_pattern.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>
#include <regex>
#include <utility>

#include "core/base/error.hpp"
#include "drivers/replay/name_fields.hpp"

namespace fvd {

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw Error(ErrorCode::kBadInput, "--pattern '" + text + "': " + why);
}

/// With the extension in lower case.
std::string normalised(const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension().string();
  return name.substr(0, name.size() - extension.size()) + lower_case(extension);
}

NameNumber number_from(std::string text) {
  NameNumber number;
  if (text.front() == '+' || text.front() == '-') {
    number.sign = text.front();
    text.erase(0, 1);
  }
  const std::size_t point = text.find_first_of(".,");
  number.digits = text.substr(0, point);
  if (point != std::string::npos) number.fraction = text.substr(point + 1);
  return number;
}

}  // namespace

NamePattern::NamePattern(std::string text) : text_(std::move(text)) {
  if (text_.find('/') != std::string::npos) refuse(text_, "names of files only, without a folder");
  std::size_t groups = 0;
  const std::string pattern = normalised(text_);
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    const char c = pattern[at];
    if (c == '*') {
      expression_ += ".*?";
    } else if (c == '{') {
      const std::size_t end = pattern.find('}', at);
      const std::string field = end == std::string::npos ? "" : pattern.substr(at + 1, end - at - 1);
      const bool is_z = field == "z_um" || field == "z_mm" || field == "z_nm";
      if (!is_z && field != "n") refuse(text_, "a field is one of {n}, {z_um}, {z_mm}, {z_nm}");
      std::size_t& group = is_z ? z_group_ : count_group_;
      if (group != 0) refuse(text_, is_z ? "z stands in it twice" : "{n} stands in it twice");
      group = ++groups;
      if (is_z) z_unit_um_ = field == "z_mm" ? 1e3 : field == "z_nm" ? 1e-3 : 1.0;
      expression_ += is_z ? "([-+]?[0-9]+(?:[.,][0-9]+)?)" : "([0-9]+)";
      at = end;
    } else {
      if (std::ispunct(static_cast<unsigned char>(c)) != 0) expression_ += '\\';
      expression_ += c;
    }
  }
  if (groups == 0)
    refuse(text_, "it needs {n}, {z_um}, {z_mm} or {z_nm} in the place of the number that gives the order");
}

bool NamePattern::matches(const std::string& name) const {
  return std::regex_match(normalised(name), std::regex(expression_));
}

NameOrder NamePattern::order(const std::vector<std::string>& names) const {
  const std::regex expression(expression_);
  std::vector<NameNumber> keys;
  std::vector<NameNumber> heights;
  for (const std::string& name : names) {
    std::smatch match;
    const std::string text = normalised(name);
    std::regex_match(text, match, expression);
    keys.push_back(number_from(match[count_group_ != 0 ? count_group_ : z_group_].str()));
    if (z_group_ != 0) heights.push_back(number_from(match[z_group_].str()));
  }
  NameOrder result;
  result.order.resize(names.size());
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::size_t a, std::size_t b) { return compare(keys[a], keys[b]) < 0; });
  std::vector<double> values;
  std::vector<std::string> ordered;
  for (std::size_t i = 0; i < result.order.size(); ++i) {
    const std::size_t row = result.order[i];
    values.push_back(keys[row].value());
    ordered.push_back(names[row]);
    if (z_group_ != 0) result.z_um.push_back(heights[row].value() * z_unit_um_);
    if (i == 0 || compare(keys[result.order[i - 1]], keys[row]) != 0) continue;
    refuse(text_, ordered[i - 1] + " and " + ordered[i] +
                      " have the same number: put more of the names' text in the place of '*'");
  }
  result.description = text_ + " (" + std::to_string(names.size()) + " files)";
  result.gap = uneven_spacing(values, ordered, count_group_ != 0 ? 0.0 : 1e-6);
  return result;
}

}  // namespace fvd
