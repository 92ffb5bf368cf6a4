#pragma once

/// Describes results: names, types, ranges and meanings, without the values.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"

namespace fvd {

enum class Presence { kAlways, kSometimes };

/// What survives a client that keeps numbers as doubles: sequence numbers, counts of seconds and starts.
inline constexpr IntegerRange kAnySeq{0, (std::int64_t{1} << 53U) - 1};
inline constexpr IntegerRange kAnyCount{0, std::numeric_limits<std::int32_t>::max()};
/// JSON-RPC's own code of a bug, and those of this program.
inline constexpr IntegerRange kAnyErrorCode{-32768, 9999};
/// Longest text where nothing is said: no limit.
inline constexpr std::size_t kUnlimited_bytes = 1U << 24U;

class ResultFields {
 public:
  /// fields outlives it.
  explicit ResultFields(Fields& fields) : fields_(fields) {}

  void text(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const {
    text(name, kUnlimited_bytes, meaning, presence);
  }
  void text(std::string_view name, std::size_t max_bytes, std::string_view meaning,
            Presence presence = Presence::kAlways) const;
  /// One of these texts.
  void choice(std::string_view name, const std::vector<std::string>& accepted, std::string_view meaning,
              Presence presence = Presence::kAlways) const;
  void integer(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const {
    integer(name, IntegerRange{}, meaning, presence);
  }
  void integer(std::string_view name, IntegerRange range, std::string_view meaning,
               Presence presence = Presence::kAlways) const;
  void number(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;
  void number(std::string_view name, NumberRange range, std::string_view meaning,
              Presence presence = Presence::kAlways) const;
  void boolean(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;
  /// null where there is none; the meaning says why.
  void number_or_null(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;
  void choice_or_null(std::string_view name, const std::vector<std::string>& accepted, std::string_view meaning,
                      Presence presence = Presence::kAlways) const;
  /// A list of at most so many objects, each described by `element`.
  void list(std::string_view name, std::int64_t most, const std::function<void(const ResultFields&)>& element,
            std::string_view meaning, Presence presence = Presence::kAlways) const;
  /// A list, an object, or a value of several types: the meaning says which.
  void any(std::string_view name, std::string_view meaning, Presence presence = Presence::kAlways) const;

 private:
  template <typename Add>
  void add(std::string_view name, Presence presence, Add add) const;

  Fields& fields_;
};

/// What several results say alike.
inline const std::vector<std::string> kJobStates{"processing", "completed", "aborted", "failed"};
inline const std::vector<std::string> kEvaluations{"ok", "nok", "uncertain", "invalid", "undefined"};
inline const std::vector<std::string> kVerdicts{"pass", "fail", "uncertain", "invalid"};
/// The key that counts what did not fit.
void describe_left_out(const ResultFields& result);

}  // namespace fvd
