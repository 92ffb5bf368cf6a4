#include "daemon/api/result_fields.hpp"

#include "daemon/api/reply_form.hpp"

namespace fvd {

namespace {

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

void ResultFields::text(std::string_view name, std::size_t max_bytes, std::string_view meaning,
                        Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    std::string none;
    fields.text(name, none, max_bytes, meaning);
  });
}

void ResultFields::choice(std::string_view name, const std::vector<std::string>& accepted, std::string_view meaning,
                          Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    std::string none = accepted.front();
    fields.choice(name, none, accepted, meaning);
  });
}

void ResultFields::integer(std::string_view name, IntegerRange range, std::string_view meaning,
                           Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    std::int64_t none = 0;
    fields.integer64(name, none, range, meaning);
  });
}

void ResultFields::number(std::string_view name, std::string_view meaning, Presence presence) const {
  number(name, kAnyNumber, meaning, presence);
}

void ResultFields::number(std::string_view name, NumberRange range, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    double none = 0.0;
    fields.number(name, none, range, meaning);
  });
}

void ResultFields::boolean(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    bool none = false;
    fields.boolean(name, none, meaning);
  });
}

void ResultFields::number_or_null(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    bool is_null = false;
    double none = 0.0;
    fields.nullable_field(name, is_null, [&](Fields& value) { value.number(name, none, kAnyNumber, meaning); });
  });
}

void ResultFields::choice_or_null(std::string_view name, const std::vector<std::string>& accepted,
                                  std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    bool is_null = false;
    std::string none = accepted.front();
    fields.nullable_field(name, is_null, [&](Fields& value) { value.choice(name, none, accepted, meaning); });
  });
}

void ResultFields::list(std::string_view name, std::int64_t most,
                        const std::function<void(const ResultFields&)>& element, std::string_view meaning,
                        Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    const ObjectList none{0, {}, [&element](Fields& described) { element(ResultFields(described)); }};
    static_cast<void>(fields.object_list(name, none, {0, most}, meaning));
  });
}

void ResultFields::any(std::string_view name, std::string_view meaning, Presence presence) const {
  add(name, presence, [&](Fields& fields) {
    std::string none;
    fields.any(name, none, kUnlimited_bytes, meaning);
  });
}

void describe_left_out(const ResultFields& result) {
  result.integer(kLeftOutKey, kAnyCount, "so many values did not fit into the reply and are left out; absent = none",
                 Presence::kSometimes);
}

}  // namespace fvd
