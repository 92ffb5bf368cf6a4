#include "config/field_writer.hpp"

#include <algorithm>

#include "config/relation.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

class ValueWriter final : public Fields {
 public:
  ordered_json object = ordered_json::object();

  void group(std::string_view name, std::string_view, const std::function<void(Fields&)>& members) override {
    ValueWriter inner;
    members(inner);
    put(name, std::move(inner.object));
  }
  void integer64(std::string_view name, std::int64_t& value, IntegerRange, std::string_view) override {
    put(name, value);
  }
  void number(std::string_view name, double& value, NumberRange, std::string_view) override { put(name, value); }
  void boolean(std::string_view name, bool& value, std::string_view) override { put(name, value); }
  void text(std::string_view name, std::string& value, std::size_t, std::string_view) override { put(name, value); }
  void choice(std::string_view name, std::string& value, const std::vector<std::string>&, std::string_view) override {
    put(name, value);
  }
  void choices(std::string_view name, std::vector<std::string>& values, const std::vector<std::string>&,
               std::string_view) override {
    put(name, values);
  }
  bool object_list(std::string_view name, const ObjectList& list, IntegerRange, std::string_view) override {
    ordered_json elements = ordered_json::array();
    for (std::size_t i = 0; i < list.size; ++i) {
      ValueWriter element;
      list.describe(i, element);
      elements.push_back(std::move(element.object));
    }
    put(name, std::move(elements));
    return false;
  }
  void variant(std::string_view key, std::string& value, const std::vector<Shape>& shapes, std::string_view) override {
    put(key, value);
    for (const Shape& shape : shapes) {
      if (shape.name == value) shape.members(*this);
    }
  }
  void optional_field(std::string_view, bool& present, const std::function<void(Fields&)>& member) override {
    if (present) member(*this);
  }
  void relate(std::string_view, double, Relation, std::string_view, double, double) override {}
  void require(std::string_view) override {}

 private:
  void put(std::string_view name, ordered_json value) { object[std::string(name)] = std::move(value); }
};

/// What one shape of an object has.
struct ShapeSchema {
  ordered_json properties = ordered_json::object();
  std::vector<std::string> required;

  void require(const std::string& name) {
    if (std::find(required.begin(), required.end(), name) == required.end()) required.push_back(name);
  }
  [[nodiscard]] ordered_json schema() const {
    ordered_json object{{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
    if (!required.empty()) object["required"] = required;
    return object;
  }
};

class SchemaWriter final : public Fields {
 public:
  /// Every shape that the object can have; one where it has no variants.
  std::vector<ShapeSchema> shapes{ShapeSchema{}};

  [[nodiscard]] ordered_json schema() const {
    if (shapes.size() == 1) return shapes.front().schema();
    ordered_json one_of = ordered_json::array();
    for (const ShapeSchema& shape : shapes) one_of.push_back(shape.schema());
    return {{"oneOf", std::move(one_of)}};
  }

  void group(std::string_view name, std::string_view meaning, const std::function<void(Fields&)>& members) override {
    SchemaWriter inner;
    members(inner);
    ordered_json schema = inner.schema();
    put(name, std::move(schema), meaning);
  }
  void integer64(std::string_view name, std::int64_t& value, IntegerRange range, std::string_view meaning) override {
    put(name, {{"type", "integer"}, {"minimum", range.min}, {"maximum", range.max}, {"default", value}}, meaning);
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
    put(name, {{"type", "array"}, {"items", {{"enum", accepted}}}, {"uniqueItems", true}, {"default", values}},
        meaning);
  }
  bool object_list(std::string_view name, const ObjectList& list, IntegerRange count,
                   std::string_view meaning) override {
    SchemaWriter element;
    list.describe_new(element);
    ValueWriter values;
    static_cast<void>(values.object_list(name, list, count, meaning));
    put(name,
        {{"type", "array"},
         {"items", element.schema()},
         {"minItems", count.min},
         {"maxItems", count.max},
         {"default", values.object[std::string(name)]}},
        meaning);
    return false;
  }
  void variant(std::string_view key, std::string& value, const std::vector<Shape>& choices_of_key,
               std::string_view meaning) override {
    std::vector<ShapeSchema> combined;
    for (const Shape& choice : choices_of_key) {
      SchemaWriter branch;
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
  void optional_field(std::string_view name, bool& present, const std::function<void(Fields&)>& member) override {
    member(*this);
    if (present) return;
    for (ShapeSchema& shape : shapes) shape.properties[std::string(name)].erase("default");
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
  void put(std::string_view name, ordered_json schema, std::string_view meaning) {
    schema["description"] = meaning;
    for (ShapeSchema& shape : shapes) shape.properties[std::string(name)] = schema;
  }
};

}  // namespace

ordered_json fields_to_json(const std::function<void(Fields&)>& describe) {
  ValueWriter writer;
  describe(writer);
  return writer.object;
}

ordered_json fields_to_schema(const std::function<void(Fields&)>& describe, const std::string& title) {
  SchemaWriter writer;
  writer.shapes.front().properties["$schema"] = {{"type", "string"}, {"description", "for editors; ignored"}};
  describe(writer);
  ordered_json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  schema.update(writer.schema());
  return schema;
}

}  // namespace fvd
