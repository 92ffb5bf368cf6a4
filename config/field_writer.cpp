#include "config/field_writer.hpp"

#include <cmath>

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
  void require(std::string_view) override {}

 private:
  void put(std::string_view name, ordered_json value) { object[std::string(name)] = std::move(value); }
};

class SchemaWriter final : public Fields {
 public:
  ordered_json properties = ordered_json::object();
  ordered_json required = ordered_json::array();

  [[nodiscard]] ordered_json schema() const {
    ordered_json object{{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
    if (!required.empty()) object["required"] = required;
    return object;
  }

  void group(std::string_view name, std::string_view meaning, const std::function<void(Fields&)>& members) override {
    SchemaWriter inner;
    members(inner);
    ordered_json schema = inner.schema();
    schema["description"] = meaning;
    properties[std::string(name)] = std::move(schema);
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
  void require(std::string_view name) override {
    required.push_back(name);
    properties[std::string(name)].erase("default");
  }

 private:
  void put(std::string_view name, ordered_json schema, std::string_view meaning) {
    schema["description"] = meaning;
    properties[std::string(name)] = std::move(schema);
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
  writer.properties["$schema"] = {{"type", "string"}, {"description", "for editors; ignored"}};
  describe(writer);
  ordered_json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  schema.update(writer.schema());
  return schema;
}

}  // namespace fvd
