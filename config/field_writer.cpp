#include "config/field_writer.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

class ValueWriter final : public Fields {
 public:
  ordered_json object = ordered_json::object();

  void group_of(std::string_view, std::string_view name, std::string_view,
                const std::function<void(Fields&)>& members) override {
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
  void numbers(std::string_view name, std::vector<double>& values, NumberRange, IntegerRange,
               std::string_view) override {
    put(name, values);
  }
  void any(std::string_view name, std::string& json_text, std::size_t, std::string_view) override {
    if (!json_text.empty()) put(name, ordered_json::parse(json_text));
  }
  bool object_list(std::string_view name, const ObjectList& list, IntegerRange, std::string_view) override {
    ordered_json elements = ordered_json::array();
    for (std::size_t i = 0; i < list.size; ++i) {
      ValueWriter element;
      list.describe(i, element);
      elements.push_back(list.rows ? row_of(element.object) : std::move(element.object));
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
  void keyed_variant(std::string& value, const std::vector<Shape>& shapes) override {
    for (const Shape& shape : shapes) {
      if (shape.name == value) shape.members(*this);
    }
  }
  bool keyed_values(std::string_view name, const KeyedValues& values, std::string_view) override {
    ValueWriter inner;
    for (const std::string& key : values.keys) values.describe(key, inner);
    put(name, std::move(inner.object));
    return false;
  }
  void word_or(std::string_view name, std::string& word, const std::vector<std::string>&,
               const std::function<void(Fields&)>& member) override {
    if (word.empty()) {
      member(*this);
    } else {
      put(name, word);
    }
  }
  void optional_field(std::string_view, bool& present, const std::function<void(Fields&)>& member) override {
    if (present) member(*this);
  }
  void nullable_field(std::string_view name, bool& is_null, const std::function<void(Fields&)>& member) override {
    if (is_null) {
      put(name, nullptr);
    } else {
      member(*this);
    }
  }
  void relate(std::string_view, double, Relation, std::string_view, double, double) override {}
  void require(std::string_view) override {}

 private:
  static ordered_json row_of(const ordered_json& members) {
    ordered_json row = ordered_json::array();
    for (const auto& [position, value] : members.items()) row.push_back(value);
    return row;
  }
  void put(std::string_view name, ordered_json value) { object[std::string(name)] = std::move(value); }
};

}  // namespace

ordered_json fields_to_json(const std::function<void(Fields&)>& describe) {
  ValueWriter writer;
  describe(writer);
  return writer.object;
}

}  // namespace fvd
