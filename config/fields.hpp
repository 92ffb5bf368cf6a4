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
#include <string>
#include <string_view>
#include <vector>

namespace fvd {

/// Closed range of an integer.
struct IntegerRange {
  std::int64_t min = std::numeric_limits<std::int64_t>::min();
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
};

/// Range of a number; open at the bottom where above_min is set.
struct NumberRange {
  double min = -1e12;
  double max = 1e12;
  bool above_min = false;
};

/// A number greater than 0, up to max.
constexpr NumberRange positive(double max = 1e12) { return {0.0, max, true}; }

class Fields {
 public:
  virtual ~Fields() = default;

  virtual void group(std::string_view name, std::string_view meaning, const std::function<void(Fields&)>& members) = 0;
  virtual void integer64(std::string_view name, std::int64_t& value, IntegerRange range, std::string_view meaning) = 0;
  virtual void number(std::string_view name, double& value, NumberRange range, std::string_view meaning) = 0;
  virtual void boolean(std::string_view name, bool& value, std::string_view meaning) = 0;
  virtual void text(std::string_view name, std::string& value, std::size_t max_length, std::string_view meaning) = 0;
  virtual void choice(std::string_view name, std::string& value, const std::vector<std::string>& accepted,
                      std::string_view meaning) = 0;
  /// A list without repetitions.
  virtual void choices(std::string_view name, std::vector<std::string>& values,
                       const std::vector<std::string>& accepted, std::string_view meaning) = 0;

  /// Marks the field of this name, described before, as one that a document must give.
  virtual void require(std::string_view name) = 0;

  /// Any other integer type, and anything made of an integer, through a copy.
  template <typename Integer>
  void integer(std::string_view name, Integer& value, IntegerRange range, std::string_view meaning) {
    auto wide = static_cast<std::int64_t>(value);
    integer64(name, wide, range, meaning);
    value = static_cast<Integer>(wide);
  }
};

}  // namespace fvd
