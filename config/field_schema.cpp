/// JSON Schema of a description.

#include <algorithm>

#include "config/field_writer.hpp"
#include "config/relation.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

/// Of the texts "0x1A" that are 0..max, for a max of 16 or 32 bits.
std::string hex_pattern(std::int64_t max) { return max > 0xFFFF ? "^0x[0-9A-Fa-f]{1,8}$" : "^0x[0-9A-Fa-f]{1,4}$"; }

/// What one shape of an object has.
struct ShapeSchema {
  ordered_json properties = ordered_json::object();
  std::vector<std::string> required;
  ordered_json other_keys = false;

  void require(const std::string& name) {
    if (std::find(required.begin(), required.end(), name) == required.end()) required.push_back(name);
  }
  [[nodiscard]] ordered_json schema() const {
    ordered_json object{{"type", "object"}, {"additionalProperties", other_keys}, {"properties", properties}};
    if (!required.empty()) object["required"] = required;
    return object;
  }
};

class SchemaWriter final : public Fields {
 public:
  /// definitions: of the whole schema, by type; outlives the writer.
  explicit SchemaWriter(ordered_json& definitions) : definitions_(definitions) {}

  /// Every shape that the object can have; one where it has no variants.
  std::vector<ShapeSchema> shapes{ShapeSchema{}};

  [[nodiscard]] ordered_json schema() const {
    if (shapes.size() == 1) return shapes.front().schema();
    ordered_json one_of = ordered_json::array();
    for (const ShapeSchema& shape : shapes) one_of.push_back(shape.schema());
    return {{"oneOf", std::move(one_of)}};
  }

  void group_of(std::string_view type, std::string_view name, std::string_view meaning,
                const std::function<void(Fields&)>& members) override {
    put(name, schema_of(std::string(type), members), meaning);
  }
  void integer64(std::string_view name, std::int64_t& value, IntegerRange range, std::string_view meaning) override {
    ordered_json schema{{"type", "integer"}, {"minimum", range.min}, {"maximum", range.max}};
    if (range.hex) {
      ordered_json text{{"type", "string"}, {"pattern", hex_pattern(range.max)}};
      schema = {{"anyOf", ordered_json::array({std::move(schema), std::move(text)})}};
    }
    schema["default"] = value;
    put(name, std::move(schema), meaning);
  }
  void number(std::string_view name, double& value, NumberRange range, std::string_view meaning) override {
    put(name,
        {{"type", "number"},
         {range.above_min ? "exclusiveMinimum" : "minimum", range.min},
         {"maximum", range.max},
         {"default", value}},
        meaning);
  }
  void boolean(std::string_view name, bool& value, std::string_view meaning) override {
    put(name, {{"type", "boolean"}, {"default", value}}, meaning);
  }
  void text(std::string_view name, std::string& value, std::size_t max_length, std::string_view meaning) override {
    put(name, {{"type", "string"}, {"maxLength", max_length}, {"default", value}}, meaning);
  }
  void choice(std::string_view name, std::string& value, const std::vector<std::string>& accepted,
              std::string_view meaning) override {
    put(name, {{"enum", accepted}, {"default", value}}, meaning);
  }
  void choices(std::string_view name, std::vector<std::string>& values, const std::vector<std::string>& accepted,
               std::string_view meaning) override {
    ordered_json item{{"enum", accepted}};
    if (accepted.empty()) item = {{"type", "string"}, {"minLength", 1}, {"maxLength", kMaxWordLength}};
    put(name, {{"type", "array"}, {"items", std::move(item)}, {"uniqueItems", true}, {"default", values}}, meaning);
  }
  void numbers(std::string_view name, std::vector<double>& values, NumberRange range, IntegerRange count,
               std::string_view meaning) override {
    ordered_json item{
        {"type", "number"}, {range.above_min ? "exclusiveMinimum" : "minimum", range.min}, {"maximum", range.max}};
    put(name,
        {{"type", "array"},
         {"items", std::move(item)},
         {"minItems", count.min},
         {"maxItems", count.max},
         {"default", values}},
        meaning);
  }
  void any(std::string_view name, std::string&, std::size_t, std::string_view meaning) override {
    put(name, ordered_json::object(), meaning);
  }
  bool object_list(std::string_view name, const ObjectList& list, IntegerRange count,
                   std::string_view meaning) override {
    const ordered_json values =
        fields_to_json([&](Fields& fields) { static_cast<void>(fields.object_list(name, list, count, meaning)); });
    put(name,
        {{"type", "array"},
         {"items", list.rows ? row_schema(list) : schema_of(list.type, list.describe_new)},
         {"minItems", count.min},
         {"maxItems", count.max},
         {"default", values.at(std::string(name))}},
        meaning);
    return false;
  }
  void variant(std::string_view key, std::string& value, const std::vector<Shape>& choices_of_key,
               std::string_view meaning) override {
    std::vector<ShapeSchema> combined;
    for (const Shape& choice : choices_of_key) {
      SchemaWriter branch(definitions_);
      branch.shapes = shapes;
      ordered_json chosen{{"const", choice.name}};
      if (choice.name == value) chosen["default"] = value;
      branch.put(key, std::move(chosen), meaning);
      // Without the key the object has the default's shape.
      if (choice.name != value) branch.require(key);
      choice.members(branch);
      combined.insert(combined.end(), branch.shapes.begin(), branch.shapes.end());
    }
    shapes = std::move(combined);
  }
  void keyed_variant(std::string&, const std::vector<Shape>& choices_of_key) override {
    std::vector<ShapeSchema> combined;
    for (const Shape& choice : choices_of_key) {
      SchemaWriter branch(definitions_);
      branch.shapes = shapes;
      choice.members(branch);
      branch.require(choice.name);
      combined.insert(combined.end(), branch.shapes.begin(), branch.shapes.end());
    }
    shapes = std::move(combined);
  }
  bool keyed_values(std::string_view name, const KeyedValues& values, std::string_view meaning) override {
    const std::string any_key = "KEY";
    SchemaWriter inner(definitions_);
    values.describe_new(any_key, inner);
    ShapeSchema& shape = inner.shapes.front();
    shape.other_keys = shape.properties.at(any_key);
    shape.properties.clear();
    put(name, shape.schema(), meaning);
    return false;
  }
  void word_or(std::string_view name, std::string&, const std::vector<std::string>& words,
               const std::function<void(Fields&)>& member) override {
    SchemaWriter scratch(definitions_);
    member(scratch);
    ordered_json other = scratch.shapes.front().properties.at(std::string(name));
    const std::string meaning = other.value("description", "");
    other.erase("description");
    other.erase("default");
    ordered_json word{{"type", "string"}, {"maxLength", kMaxWordLength}};
    if (!words.empty()) word = {{"enum", words}};
    put(name, {{"anyOf", ordered_json::array({std::move(word), std::move(other)})}}, meaning);
  }
  void optional_field(std::string_view name, bool& present, const std::function<void(Fields&)>& member) override {
    member(*this);
    if (present) return;
    for (ShapeSchema& shape : shapes) shape.properties[std::string(name)].erase("default");
  }
  void nullable_field(std::string_view name, bool& is_null, const std::function<void(Fields&)>& member) override {
    member(*this);
    for (ShapeSchema& shape : shapes) accept_null(shape.properties[std::string(name)], is_null);
  }
  /// Draft 7 cannot compare two values: the schema says it in words.
  void relate(std::string_view name, double, Relation relation, std::string_view other, double,
              double offset) override {
    for (ShapeSchema& shape : shapes) {
      ordered_json& description = shape.properties[std::string(name)]["description"];
      description = description.get<std::string>() + "; " + relation_text(relation, other, offset);
    }
  }
  void require(std::string_view name) override {
    for (ShapeSchema& shape : shapes) {
      shape.require(std::string(name));
      shape.properties[std::string(name)].erase("default");
    }
  }

 private:
  static void accept_null(ordered_json& schema, bool is_default) {
    if (schema.contains("enum")) {
      schema["enum"].push_back(nullptr);
    } else if (schema.contains("type")) {
      schema["type"] = ordered_json::array({schema["type"], "null"});
    } else if (schema.contains("anyOf")) {
      schema["anyOf"].push_back({{"type", "null"}});
    } else if (schema.contains("allOf") || schema.contains("oneOf")) {
      const ordered_json meaning = schema["description"];
      schema.erase("description");
      const ordered_json null{{"type", "null"}};
      schema = {{"anyOf", ordered_json::array({schema, null})}, {"description", meaning}};
    }  // anything else accepts null already
    if (is_default) schema["default"] = nullptr;
  }
  /// By reference to its definition where the type has a name. The definition is begun before it is described, so that
  /// an element which contains its own type ends there.
  ordered_json schema_of(const std::string& type, const std::function<void(Fields&)>& members) {
    if (type.empty()) {
      SchemaWriter inner(definitions_);
      members(inner);
      return inner.schema();
    }
    if (!definitions_.contains(type)) {
      definitions_[type] = nullptr;
      definitions_[type] = schema_of("", members);
    }
    // Draft 7 ignores everything beside a $ref.
    return {{"allOf", ordered_json::array({{{"$ref", "#/definitions/" + type}}})}};
  }
  ordered_json row_schema(const ObjectList& list) {
    SchemaWriter inner(definitions_);
    list.describe_new(inner);
    ordered_json items = ordered_json::array();
    for (const auto& [position, member] : inner.shapes.front().properties.items()) items.push_back(member);
    const std::size_t size = items.size();
    return {{"type", "array"}, {"items", std::move(items)}, {"minItems", size}, {"maxItems", size}};
  }
  void put(std::string_view name, ordered_json schema, std::string_view meaning) {
    schema["description"] = meaning;
    for (ShapeSchema& shape : shapes) shape.properties[std::string(name)] = schema;
  }

  ordered_json& definitions_;
};

}  // namespace

ordered_json fields_to_schema(const std::function<void(Fields&)>& describe, const std::string& title) {
  ordered_json definitions = ordered_json::object();
  SchemaWriter writer(definitions);
  writer.shapes.front().properties["$schema"] = {{"type", "string"}, {"description", "for editors; ignored"}};
  describe(writer);
  ordered_json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  schema.update(writer.schema());
  if (!definitions.empty()) schema["definitions"] = std::move(definitions);
  return schema;
}

}  // namespace fvd
