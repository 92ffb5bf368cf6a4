#pragma once

/// One description of a structure's fields from which reading, writing and the JSON schema all follow.
///
/// A structure is described by one function that names every field with its range and meaning:
///
///   void describe(RpcConfig& rpc, Fields& fields) {
///     fields.integer("port", rpc.port, {0, 65535}, "TCP port, 0 = any free one");
///   }
///
/// FieldReader fills the structure from JSON, FieldWriter makes JSON of it, FieldSchema makes the schema.

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fvd {

/// Closed range of an integer.
struct IntegerRange {
  std::int64_t min = std::numeric_limits<std::int64_t>::min();
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
  bool hex = false;  ///< a text "0x1A" is accepted too
};

/// Range of a number; open at the bottom where above_min is set.
struct NumberRange {
  double min = -1e12;
  double max = 1e12;
  bool above_min = false;
};

/// A number greater than 0, up to max.
constexpr NumberRange positive(double max = 1e12) { return {0.0, max, true}; }

/// How a value must compare with the value of another key plus an offset.
enum class Relation { kBelow, kAtMost, kAbove, kAtLeast };

/// Longest text in bytes that may stand in place of an object.
inline constexpr std::size_t kMaxWordLength = 256;

class Fields;

/// The elements of a list, without their type.
struct ObjectList {
  std::size_t size = 0;                                ///< elements the structure has
  std::function<void(std::size_t, Fields&)> describe;  ///< describes one of them, index below size
  std::function<void(Fields&)> describe_new;           ///< describes one more, all its values at their defaults
  std::string type{};  ///< the schema's name for an element; needed where an element can contain others of its type
  bool rows = false;   ///< an element is written as a list [a, b]; its members are named "0", "1", ...
};

/// How the elements of a list are written; the members are those of ObjectList.
struct ListForm {
  std::string type{};
  bool rows = false;
};

/// An object whose keys are the document's own, without the type of its values.
struct KeyedValues {
  std::vector<std::string> keys;                                      ///< that the structure has
  std::function<void(const std::string& key, Fields&)> describe;      ///< describes the field of one of them
  std::function<void(const std::string& key, Fields&)> describe_new;  ///< describes the field of a new key
};

/// One of the shapes an object can have.
struct Shape {
  std::string name;  ///< variant: the key's value that chooses it; keyed_variant: the key whose presence does
  std::function<void(Fields&)> members;
};

class Fields {
 public:
  virtual ~Fields() = default;

  /// An object of a named type: the schema defines the type once, so that it can contain itself. A reader
  /// skips the members where the document has no such object. An empty type means no type.
  virtual void group_of(std::string_view type, std::string_view name, std::string_view meaning,
                        const std::function<void(Fields&)>& members) = 0;
  virtual void integer64(std::string_view name, std::int64_t& value, IntegerRange range, std::string_view meaning) = 0;
  virtual void number(std::string_view name, double& value, NumberRange range, std::string_view meaning) = 0;
  virtual void boolean(std::string_view name, bool& value, std::string_view meaning) = 0;
  virtual void text(std::string_view name, std::string& value, std::size_t max_length, std::string_view meaning) = 0;
  virtual void choice(std::string_view name, std::string& value, const std::vector<std::string>& accepted,
                      std::string_view meaning) = 0;
  /// A list without repetitions. Without accepted names any text of up to kMaxWordLength bytes is one.
  virtual void choices(std::string_view name, std::vector<std::string>& values,
                       const std::vector<std::string>& accepted, std::string_view meaning) = 0;

  /// A list of numbers. count: how many there may be.
  virtual void numbers(std::string_view name, std::vector<double>& values, NumberRange range, IntegerRange count,
                       std::string_view meaning) = 0;

  /// Any JSON value of at most max_bytes as text, kept as its text; empty = none.
  virtual void any(std::string_view name, std::string& json_text, std::size_t max_bytes, std::string_view meaning) = 0;

  /// True where the elements made by describe_new replace the structure's. list() is the typed form.
  [[nodiscard]] virtual bool object_list(std::string_view name, const ObjectList& list, IntegerRange count,
                                         std::string_view meaning) = 0;
  /// Members that only one of several shapes has, beside the key that chooses it. value names a shape, the default.
  virtual void variant(std::string_view key, std::string& value, const std::vector<Shape>& shapes,
                       std::string_view meaning) = 0;
  /// The same without a key that chooses: the shape is the one whose name is a key of this object. value: that name;
  /// where it is empty, a writer writes nothing.
  virtual void keyed_variant(std::string& value, const std::vector<Shape>& shapes) = 0;
  /// True where the values described by describe_new replace the structure's. map() is the typed form.
  [[nodiscard]] virtual bool keyed_values(std::string_view name, const KeyedValues& values,
                                          std::string_view meaning) = 0;
  /// A field whose value is one of these words, or what member describes under the same name. Without words any text of
  /// up to kMaxWordLength bytes counts as a word. word: empty where the value is not a word.
  virtual void word_or(std::string_view name, std::string& word, const std::vector<std::string>& words,
                       const std::function<void(Fields&)>& member) = 0;
  /// A field that may have no value: member describes the field `name`, present says whether the field has a value.
  /// optional() is the typed form.
  virtual void optional_field(std::string_view name, bool& present, const std::function<void(Fields&)>& member) = 0;
  /// A field whose value is null, or what member describes under the same name. is_null: which of them.
  virtual void nullable_field(std::string_view name, bool& is_null, const std::function<void(Fields&)>& member) = 0;
  /// Refuses a value of `name` that does not stand in this relation to `other` + offset. Both are fields of this
  /// object, described before; their values are given as read, in the unit of their keys.
  virtual void relate(std::string_view name, double value, Relation relation, std::string_view other,
                      double other_value, double offset = 0.0) = 0;

  /// Marks the field of this name, described before, as one that a document must give.
  virtual void require(std::string_view name) = 0;

  void group(std::string_view name, std::string_view meaning, const std::function<void(Fields&)>& members) {
    group_of("", name, meaning, members);
  }

  /// Any other integer type, and anything made of an integer, through a copy.
  template <typename Integer>
  void integer(std::string_view name, Integer& value, IntegerRange range, std::string_view meaning) {
    auto wide = static_cast<std::int64_t>(value);
    integer64(name, wide, range, meaning);
    value = static_cast<Integer>(wide);
  }

  /// A list of objects, each described by describe(Fields&, Element&). count: how many there may be, 0 or more.
  template <typename Element, typename Describe>
  void list(std::string_view name, std::vector<Element>& values, IntegerRange count, std::string_view meaning,
            Describe describe, const ListForm& form = {}) {
    std::vector<Element> made;
    const ObjectList access{values.size(), [&](std::size_t i, Fields& fields) { describe(fields, values[i]); },
                            [&](Fields& fields) { describe(fields, made.emplace_back()); }, form.type, form.rows};
    if (object_list(name, access, count, meaning)) values = std::move(made);
  }

  /// An object with keys of the document's own: describe(Fields&, const std::string& key, Element&) describes the field
  /// of one key.
  template <typename Element, typename Describe>
  void map(std::string_view name, std::map<std::string, Element>& values, std::string_view meaning, Describe describe) {
    std::map<std::string, Element> made;
    KeyedValues access{{},
                       [&](const std::string& key, Fields& fields) { describe(fields, key, values.at(key)); },
                       [&](const std::string& key, Fields& fields) { describe(fields, key, made[key]); }};
    for (const auto& [key, value] : values) access.keys.push_back(key);
    if (keyed_values(name, access, meaning)) values = std::move(made);
  }

  /// A field that may have no value: describe(Fields&, Value&) describes it under the same name.
  template <typename Value, typename Describe>
  void optional(std::string_view name, std::optional<Value>& value, Describe describe) {
    Value held = value.value_or(Value{});
    bool present = value.has_value();
    optional_field(name, present, [&](Fields& fields) { describe(fields, held); });
    if (present) value = std::move(held);
  }
};

}  // namespace fvd
