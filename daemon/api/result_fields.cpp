#include "daemon/api/result_fields.hpp"

#include <cstddef>
#include <limits>
#include <string>

namespace fvd {

namespace {

constexpr std::size_t kUnlimited_bytes = 1U << 24U;
constexpr NumberRange kAnyNumber{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};

}  // namespace

template <typename Add>
void ResultFields::add(std::string_view name, Presence presence, Add add) const {
  if (presence == Presence::kAlways) {
    add(fields_);
    fields_.require(name);
  } else {
    bool present = false;
    fields_.optional_field(name, present, add);
  }
}

void ResultFields::text(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    std::string none;
    fields.text(name, none, kUnlimited_bytes, meaning);
  });
}

void ResultFields::integer(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    std::int64_t none = 0;
    fields.integer64(name, none, {}, meaning);
  });
}

void ResultFields::number(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    double none = 0.0;
    fields.number(name, none, kAnyNumber, meaning);
  });
}

void ResultFields::boolean(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    bool none = false;
    fields.boolean(name, none, meaning);
  });
}

void ResultFields::any(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    std::string none;
    fields.any(name, none, kUnlimited_bytes, meaning);
  });
}

}  // namespace fvd
