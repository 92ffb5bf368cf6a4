#include "config/field_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "config/nearest_name.hpp"
#include "config/relation.hpp"
#include "config/strict_json.hpp"

namespace fvd {

namespace {

using nlohmann::json;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

/// So many that no limit is written with an exponent.
constexpr int kDigits = 12;

std::string range_text(IntegerRange range) {
  return std::string(range.hex ? "an integer or \"0x..\" within " : "an integer within ") + std::to_string(range.min) +
         ".." + std::to_string(range.max);
}

/// "4", "0..5"
std::string count_text(IntegerRange count) {
  return std::to_string(count.min) + (count.min == count.max ? "" : ".." + std::to_string(count.max));
}

std::string range_text(NumberRange range) {
  std::ostringstream text;
  text << std::setprecision(kDigits);
  if (range.above_min) {
    text << "a number above " << range.min << " and up to " << range.max;
  } else {
    text << "a number within " << range.min << ".." << range.max;
  }
  return text.str();
}

std::string escaped(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c == '~') {
      text += "~0";
    } else if (c == '/') {
      text += "~1";
    } else {
      text += c;
    }
  }
  return text;
}

/// A whole number that fits, where hex is allowed also one written as "0x1A", which JSON has no other way to say.
std::optional<std::int64_t> whole_number(const json& value, bool hex) {
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) return std::nullopt;
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (!hex || !value.is_string()) return std::nullopt;
  const auto& text = value.get_ref<const std::string&>();
  std::uint32_t number = 0;
  if (!text.starts_with("0x")) return std::nullopt;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), number, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

bool is_within(NumberRange range, double number) {
  return (range.above_min ? number > range.min : number >= range.min) && number <= range.max;
}

bool accepts(const std::vector<std::string>& accepted, const json& value) {
  return value.is_string() && std::find(accepted.begin(), accepted.end(), value.get<std::string>()) != accepted.end();
}

}  // namespace

FieldReader::FieldReader(const json& object, Problems& problems, std::string pointer)
    : object_(object), problems_(problems), pointer_(std::move(pointer)) {
  if (!object_.is_object()) problems_.push_back({pointer_, shown(object_) + " is not an object { }"});
}

void FieldReader::finish() {
  if (!object_.is_object()) return;
  for (const auto& [name, value] : object_.items()) {
    if (known_.contains(name) || (pointer_.empty() && name == "$schema")) continue;
    report(name, row_ ? "is one too many" : "unknown key" + did_you_mean(name, {known_.begin(), known_.end()}));
  }
}

void FieldReader::report(std::string_view name, const std::string& message) {
  problems_.push_back({pointer_ + "/" + escaped(name), message});
}

void FieldReader::refuse(std::string_view name, const json& value, const std::string& accepted, const char* verb) {
  refused_.emplace(name);
  report(name, shown(value) + " is not accepted; " + verb + " " + accepted);
}

const json* FieldReader::find(std::string_view name) {
  known_.emplace(name);
  if (!object_.is_object()) return nullptr;
  const auto found = object_.find(std::string(name));
  return found == object_.end() ? nullptr : &*found;
}

void FieldReader::group_of(std::string_view type, std::string_view name, std::string_view /*meaning*/,
                           const std::function<void(Fields&)>& members) {
  static const json kEmpty = json::object();
  const json* value = find(name);
  if (value == nullptr && !type.empty()) return;
  FieldReader inner(value != nullptr ? *value : kEmpty, problems_, pointer_ + "/" + escaped(name));
  members(inner);
  inner.finish();
}

void FieldReader::integer64(std::string_view name, std::int64_t& value, IntegerRange range,
                            std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  const auto number = whole_number(*found, range.hex);
  if (number && *number >= range.min && *number <= range.max) {
    value = *number;
    return;
  }
  if (range.min == range.max) return refuse(name, *found, std::to_string(range.min), "must be");
  refuse(name, *found, range_text(range));
}

void FieldReader::number(std::string_view name, double& value, NumberRange range, std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  const double number = found->is_number() ? found->get<double>() : std::nan("");
  if (!is_within(range, number)) return refuse(name, *found, range_text(range));
  value = number;
}

void FieldReader::boolean(std::string_view name, bool& value, std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  if (!found->is_boolean()) return refuse(name, *found, "true or false");
  value = found->get<bool>();
}

void FieldReader::text(std::string_view name, std::string& value, std::size_t max_length,
                       std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  if (!found->is_string() || found->get_ref<const std::string&>().size() > max_length) {
    return refuse(name, *found, "a text of at most " + std::to_string(max_length) + " bytes");
  }
  value = found->get<std::string>();
}

void FieldReader::choice(std::string_view name, std::string& value, const std::vector<std::string>& accepted,
                         std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  if (!accepts(accepted, *found)) return refuse(name, *found, "one of " + joined(accepted));
  value = found->get<std::string>();
}

void FieldReader::choices(std::string_view name, std::vector<std::string>& values,
                          const std::vector<std::string>& accepted, std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  const std::string expected =
      "a list without repetitions of " + (accepted.empty() ? std::string("texts") : joined(accepted));
  const auto is_one = [&accepted](const json& item) {
    if (!accepted.empty()) return accepts(accepted, item);
    if (!item.is_string()) return false;
    const std::size_t size = item.get_ref<const std::string&>().size();
    return size > 0 && size <= kMaxWordLength;
  };
  if (!found->is_array()) return refuse(name, *found, expected);
  std::vector<std::string> read;
  std::set<std::string_view> seen;  // to look through `read` for each item takes minutes for a message of 1 MiB
  for (const json& item : *found) {
    if (!is_one(item)) return refuse(name, item, expected);
    const auto& word = item.get_ref<const std::string&>();
    if (!seen.emplace(word).second) return refuse(name, item, expected);
    read.push_back(word);
  }
  values = std::move(read);
}

void FieldReader::numbers(std::string_view name, std::vector<double>& values, NumberRange range, IntegerRange count,
                          std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  const auto size = static_cast<std::int64_t>(found->size());
  const auto is_one = [&range](const json& item) { return item.is_number() && is_within(range, item.get<double>()); };
  if (!found->is_array() || size < count.min || size > count.max ||
      !std::all_of(found->begin(), found->end(), is_one)) {
    return refuse(name, *found, "a list of " + count_text(count) + " numbers, each " + range_text(range));
  }
  values = found->get<std::vector<double>>();
}

void FieldReader::any(std::string_view name, std::string& json_text, std::size_t max_bytes,
                      std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return;
  std::string text = found->dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > max_bytes) return refuse(name, *found, "at most " + std::to_string(max_bytes) + " bytes as JSON");
  json_text = std::move(text);
}

bool FieldReader::object_list(std::string_view name, const ObjectList& list, IntegerRange count,
                              std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return false;
  const auto size = static_cast<std::int64_t>(found->size());
  if (!found->is_array() || size < count.min || size > count.max) {
    refuse(name, *found, "a list of " + count_text(count) + (list.rows ? " lists [ ]" : " objects { }"));
    return false;
  }
  const std::size_t problems_before = problems_.size();
  for (std::size_t i = 0; i < found->size(); ++i) {
    const std::string pointer = pointer_ + "/" + escaped(name) + "/" + std::to_string(i);
    if (list.rows) {
      read_row((*found)[i], list, pointer);
      continue;
    }
    FieldReader element((*found)[i], problems_, pointer);
    list.describe_new(element);
    element.finish();
  }
  return problems_.size() == problems_before;
}

void FieldReader::read_row(const json& row, const ObjectList& list, const std::string& pointer) {
  if (!row.is_array()) return problems_.push_back({pointer, shown(row) + " is not a list [ ]"});
  json members = json::object();
  for (std::size_t i = 0; i < row.size(); ++i) members[std::to_string(i)] = row[i];
  FieldReader element(members, problems_, pointer);
  element.row_ = true;
  list.describe_new(element);
  element.finish();
}

void FieldReader::variant(std::string_view key, std::string& value, const std::vector<Shape>& shapes,
                          std::string_view meaning) {
  std::vector<std::string> names;
  for (const Shape& shape : shapes) names.push_back(shape.name);
  const std::size_t problems_before = problems_.size();
  choice(key, value, names, meaning);
  if (problems_.size() == problems_before) {
    for (const Shape& shape : shapes) {
      if (shape.name == value) shape.members(*this);
    }
    return;
  }
  know_members(shapes);
}

void FieldReader::know_members(const std::vector<Shape>& shapes) {
  static const json kEmpty = json::object();
  Problems ignored;
  FieldReader names_only(kEmpty, ignored);
  for (const Shape& shape : shapes) shape.members(names_only);
  known_.insert(names_only.known_.begin(), names_only.known_.end());
}

void FieldReader::keyed_variant(std::string& value, const std::vector<Shape>& shapes) {
  if (!object_.is_object()) return;
  std::vector<std::string> names;
  for (const Shape& shape : shapes) {
    if (object_.contains(shape.name)) {
      value = shape.name;
      return shape.members(*this);
    }
    names.push_back(shape.name);
  }
  if (!object_.empty()) know_members(shapes);
  problems_.push_back(
      {pointer_, shown(object_) + " is not accepted; expected an object with one of the keys " + joined(names)});
}

bool FieldReader::keyed_values(std::string_view name, const KeyedValues& values, std::string_view /*meaning*/) {
  const json* found = find(name);
  if (found == nullptr) return false;
  const std::size_t problems_before = problems_.size();
  FieldReader inner(*found, problems_, pointer_ + "/" + escaped(name));
  if (found->is_object()) {
    for (const auto& [key, value] : found->items()) values.describe_new(key, inner);
  }
  return problems_.size() == problems_before;
}

void FieldReader::word_or(std::string_view name, std::string& word, const std::vector<std::string>& words,
                          const std::function<void(Fields&)>& member) {
  const json* found = find(name);
  if (found == nullptr) return;
  if (words.empty() && found->is_string()) return text(name, word, kMaxWordLength, "");
  if (accepts(words, *found)) {
    word = found->get<std::string>();
    return;
  }
  const std::size_t problems_before = problems_.size();
  word.clear();
  member(*this);
  if (problems_.size() == problems_before || found->is_object()) return;
  problems_.back().message += words.empty() ? ", or a text" : ", or one of " + joined(words);
}

void FieldReader::optional_field(std::string_view name, bool& present, const std::function<void(Fields&)>& member) {
  if (find(name) == nullptr) return;
  const std::size_t problems_before = problems_.size();
  member(*this);
  if (problems_.size() == problems_before) present = true;
}

void FieldReader::nullable_field(std::string_view name, bool& is_null, const std::function<void(Fields&)>& member) {
  const json* found = find(name);
  if (found == nullptr) return;
  is_null = found->is_null();
  if (is_null) return;
  const std::size_t problems_before = problems_.size();
  member(*this);
  if (problems_.size() > problems_before && !found->is_structured()) problems_.back().message += ", or null";
}

void FieldReader::relate(std::string_view name, double value, Relation relation, std::string_view other,
                         double other_value, double offset) {
  if (!object_.is_object() || refused_.contains(name) || refused_.contains(other)) return;
  if (holds(value, relation, other_value + offset)) return;
  std::ostringstream text;
  text.precision(15);
  text << name << " is " << value << "; expected " << relation_text(relation, other, offset) << ", and " << other
       << " is " << other_value;
  report(name, text.str());
}

void FieldReader::require(std::string_view name) {
  if (find(name) == nullptr && object_.is_object()) report(name, "is missing and has no default");
}

void read_document(std::string_view json_text, const std::function<void(Fields&)>& describe, Problems& problems) {
  const auto document = parse_strict_json(json_text, problems);
  if (!document) return;
  FieldReader reader(*document, problems);
  describe(reader);
  reader.finish();
}

}  // namespace fvd
