#include "daemon/config/config_origins.hpp"

#include <algorithm>
#include <optional>

namespace fvd {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kDefault = "default";

bool is_within(const std::string& pointer, const std::string& place) {
  return pointer.starts_with(place) && (pointer.size() == place.size() || pointer[place.size()] == '/');
}

/// What a document says of a place: true = it gives the value, false = it takes away what earlier ones gave, nothing =
/// it does not speak of it.
std::optional<bool> gives(const json& document, const std::string& pointer) {
  for (std::size_t end = pointer.find('/', 1);; end = pointer.find('/', end + 1)) {
    const json::json_pointer place(pointer.substr(0, end));
    if (!document.contains(place)) {
      // A list or a plain value stands in place of an earlier document's object.
      if (!document.at(place.parent_pointer()).is_object()) return false;
      return std::nullopt;
    }
    if (end == std::string::npos) return !document.at(place).is_null();
  }
}

class OriginWriter {
 public:
  explicit OriginWriter(const ConfigOrigins& origins) : origins_(origins) {}

  std::string write(const ordered_json& values) {
    line_ = "{";
    members(values, "", "  ");
    text_ += "}\n";
    return std::move(text_);
  }

 private:
  /// Behind the opening bracket, which waits in line_.
  void members(const ordered_json& node, const std::string& pointer, const std::string& indent) {
    end_line("");
    std::size_t left = node.size();
    for (const auto& [key, value] : node.items()) {
      const std::string place = (json::json_pointer(pointer) / key).to_string();
      line_ = indent + (node.is_object() ? json(key).dump() + ": " : "");
      const std::string comma = --left > 0 ? "," : "";
      const bool holds_objects = value.is_array() && !value.empty() && value.front().is_structured();
      if ((value.is_object() && !value.empty()) || holds_objects) {
        line_ += value.is_object() ? "{" : "[";
        members(value, place, indent + "  ");
        line_ = indent + (value.is_object() ? "}" : "]") + comma;
        end_line("");
      } else {
        line_ += value.dump() + comma;
        end_line("  // " + origins_.of(place));
      }
    }
  }
  void end_line(const std::string& comment) { text_ += line_ + comment + "\n"; }

  const ConfigOrigins& origins_;
  std::string line_;
  std::string text_;
};

}  // namespace

void ConfigOrigins::add_override(const std::string& key) {
  std::string pointer = "/" + key;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  overrides_.push_back(std::move(pointer));
}

json ConfigOrigins::merged() const {
  json all = documents_.empty() ? json::object() : documents_.front().content;
  for (std::size_t i = 1; i < documents_.size(); ++i) all.merge_patch(documents_[i].content);
  return all;
}

std::string ConfigOrigins::of(const std::string& pointer) const {
  const auto covers = [&pointer](const std::string& place) { return is_within(pointer, place); };
  if (std::any_of(overrides_.begin(), overrides_.end(), covers)) return "--set";
  for (auto document = documents_.rbegin(); document != documents_.rend(); ++document) {
    if (const auto given = gives(document->content, pointer)) return *given ? document->name : kDefault;
  }
  return kDefault;
}

std::string text_with_origins(const ordered_json& values, const ConfigOrigins& origins) {
  return OriginWriter(origins).write(values);
}

}  // namespace fvd
