#pragma once

/// Fills a described structure from JSON and collects every problem instead of stopping at the first.

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"
#include "config/problem.hpp"

namespace fvd {

/// Fields that are absent or wrong keep their value. Unknown keys are problems, with the nearest known name.
class FieldReader final : public Fields {
 public:
  /// object and problems must outlive the reader. pointer: the place of the object in its document.
  FieldReader(const nlohmann::json& object, Problems& problems, std::string pointer = "");
  /// Reports unknown keys: call when all fields are described.
  void finish();

  void group_of(std::string_view type, std::string_view name, std::string_view meaning,
                const std::function<void(Fields&)>& members) override;
  void integer64(std::string_view name, std::int64_t& value, IntegerRange range, std::string_view meaning) override;
  void number(std::string_view name, double& value, NumberRange range, std::string_view meaning) override;
  void boolean(std::string_view name, bool& value, std::string_view meaning) override;
  void text(std::string_view name, std::string& value, std::size_t max_length, std::string_view meaning) override;
  void choice(std::string_view name, std::string& value, const std::vector<std::string>& accepted,
              std::string_view meaning) override;
  void choices(std::string_view name, std::vector<std::string>& values, const std::vector<std::string>& accepted,
               std::string_view meaning) override;
  void numbers(std::string_view name, std::vector<double>& values, NumberRange range, IntegerRange count,
               std::string_view meaning) override;
  void any(std::string_view name, std::string& json_text, std::size_t max_bytes, std::string_view meaning) override;
  bool object_list(std::string_view name, const ObjectList& list, IntegerRange count,
                   std::string_view meaning) override;
  void variant(std::string_view key, std::string& value, const std::vector<Shape>& shapes,
               std::string_view meaning) override;
  void keyed_variant(std::string& value, const std::vector<Shape>& shapes) override;
  bool keyed_values(std::string_view name, const KeyedValues& values, std::string_view meaning) override;
  void word_or(std::string_view name, std::string& word, const std::vector<std::string>& words,
               const std::function<void(Fields&)>& member) override;
  void optional_field(std::string_view name, bool& present, const std::function<void(Fields&)>& member) override;
  void nullable_field(std::string_view name, bool& is_null, const std::function<void(Fields&)>& member) override;
  void relate(std::string_view name, double value, Relation relation, std::string_view other, double other_value,
              double offset) override;
  void require(std::string_view name) override;

 private:
  [[nodiscard]] const nlohmann::json* find(std::string_view name);
  void refuse(std::string_view name, const nlohmann::json& value, const std::string& accepted,
              const char* verb = "expected");
  void report(std::string_view name, const std::string& message);
  /// Accepts the keys of all shapes: where the shape is not known, only keys that no shape has are unknown.
  void know_members(const std::vector<Shape>& shapes);
  void read_row(const nlohmann::json& row, const ObjectList& list, const std::string& pointer);

  const nlohmann::json& object_;
  Problems& problems_;
  std::string pointer_;
  bool row_ = false;  ///< object_ stands for a list, its keys are the positions
  std::set<std::string, std::less<>> known_;
  std::set<std::string, std::less<>> refused_;  ///< keys whose value was refused, so that the structure holds another
};

/// Reads a whole document: problems of syntax, type, range and names, all at once.
void read_document(std::string_view json_text, const std::function<void(Fields&)>& describe, Problems& problems);

}  // namespace fvd
