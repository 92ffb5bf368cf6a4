/// The table of a schema's keys.

#include <algorithm>

#include "config/field_writer.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

std::string quoted(const ordered_json& value) {
  return "`" + (value.is_string() ? value.get<std::string>() : value.dump()) + "`";
}

std::string enumerated(const ordered_json& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + quoted(name);
  return text;
}

/// 1000000.0 as 1000000, 0.5 as it is.
std::string bound(const ordered_json& value) {
  std::string text = value.dump();
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

std::string accepted(const ordered_json& schema) {
  if (schema.contains("enum")) return enumerated(schema["enum"]);
  if (schema.contains("const")) return quoted(schema["const"]);
  if (schema.contains("allOf")) {
    const auto reference = schema["allOf"][0].value("$ref", "");
    return "a " + reference.substr(reference.rfind('/') + 1);
  }
  if (schema.contains("anyOf")) {
    if (schema["anyOf"][1].contains("pattern")) return accepted(schema["anyOf"][0]) + ", or `\"0x..\"`";
    return accepted(schema["anyOf"][0]) + ", or " + accepted(schema["anyOf"][1]);
  }
  const std::string type = schema.value("type", "");
  if (type == "string") return "text";
  if (type == "boolean") return "`true`, `false`";
  if (type == "object" || schema.contains("oneOf")) return "object";
  if (type == "array") {
    const ordered_json& items = schema["items"];
    return items.is_object() ? "list of " + accepted(items)
                             : "[" + accepted(items[0]) + ", " + accepted(items[1]) + "]";
  }
  if (schema.contains("exclusiveMinimum")) {
    return "> " + bound(schema["exclusiveMinimum"]) + " .. " + bound(schema["maximum"]);
  }
  if (schema["minimum"] == schema["maximum"]) return bound(schema["minimum"]);
  return bound(schema["minimum"]) + " .. " + bound(schema["maximum"]);
}

std::string default_of(const ordered_json& schema, bool required) {
  if (required) return "required";
  if (!schema.contains("default")) return "none";
  return schema["default"] == "" ? "empty" : quoted(schema["default"]);
}

class Table {
 public:
  std::string text = "| key | accepted | default | meaning |\n|---|---|---|---|\n";

  void add_members(const ordered_json& schema, const std::string& prefix) {
    for (const char* several : {"oneOf", "anyOf"}) {
      if (!schema.contains(several)) continue;
      for (const ordered_json& shape : schema[several]) add_members(shape, prefix);
    }
    if (!schema.contains("properties")) return;
    const ordered_json required = schema.value("required", ordered_json::array());
    for (const auto& [name, member] : schema["properties"].items()) {
      if (name == "$schema") continue;
      add(prefix + name, member, std::find(required.begin(), required.end(), name) != required.end());
    }
    if (schema["additionalProperties"].is_object()) add(prefix + "NAME", schema["additionalProperties"], false);
  }

 private:
  void add(const std::string& key, const ordered_json& member, bool required) {
    const bool is_map = member.contains("additionalProperties") && member["additionalProperties"].is_object();
    const bool is_group = member.contains("oneOf") || is_map || !member.value("properties", ordered_json()).empty();
    if (is_group) return add_members(member, key + ".");
    std::string row = "| `" + key + "` | " + accepted(member) + " | " + default_of(member, required) + " | " +
                      in_a_cell(member.value("description", "")) + " |\n";
    // Members that all shapes of an object have stand once.
    if (text.find(row) == std::string::npos) text += row;
    if (member.contains("anyOf")) add_members(member["anyOf"][1], key + ".");
    if (!member.contains("items") || !member["items"].is_object()) return;
    add_members(member["items"], key + "[].");
  }
  static std::string in_a_cell(std::string meaning) {
    for (std::size_t at = 0; (at = meaning.find('|', at)) != std::string::npos; at += 2) meaning.insert(at, "\\");
    return meaning;
  }
};

}  // namespace

std::string schema_to_table(const ordered_json& schema) {
  Table table;
  table.add_members(schema, "");
  if (!schema.contains("definitions")) return table.text;
  for (const auto& [type, definition] : schema["definitions"].items()) {
    table.add_members(definition, type + ": ");
  }
  return table.text;
}

}  // namespace fvd
