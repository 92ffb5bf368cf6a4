#pragma once

/// Describes results: names, types and meanings, without the values.

#include <string_view>

#include "config/fields.hpp"

namespace fvd {

enum class Presence { kAlways, kSometimes };

class ResultFields {
 public:
  /// fields outlives it.
  explicit ResultFields(Fields& fields) : fields_(fields) {}

  void text(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;
  void integer(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;
  void number(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;
  void boolean(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;
  /// A list, an object, or a value of several types: the meaning says which.
  void any(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;

 private:
  template <typename Add>
  void add(std::string_view name, Presence presence, Add add) const;

  Fields& fields_;
};

}  // namespace fvd
