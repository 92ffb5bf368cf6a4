#pragma once

/// Whether a measured value is good, from the value and its limits alone.

#include <optional>
#include <span>
#include <string_view>

namespace fvd {

enum class Verdict {
  kPass,       ///< the value lies within its limits; a limit itself is within
  kFail,       ///< it lies outside
  kInvalid,    ///< there is no value to judge
  kUncertain,  ///< its uncertainty lets neither be stated; judge() never says so
};

/// Limits in the unit of the value; an absent limit does not limit.
struct Limits {
  std::optional<double> lower;
  std::optional<double> upper;
  bool operator==(const Limits&) const = default;
};

/// kInvalid for a value that is absent or not finite. context: pure, as the next.
[[nodiscard]] Verdict judge(std::optional<double> value, const Limits& limits) noexcept;

/// The verdict on all of them: kFail where one failed, else kInvalid where one is invalid, else kUncertain where one
/// is, else kPass; nothing where nothing was judged. What certainly failed is not hidden by what could not be judged.
[[nodiscard]] std::optional<Verdict> joined_verdict(std::span<const Verdict> verdicts) noexcept;

/// The verdict on a part by an evaluation whose missing values are no excuse: the worst of kInvalid, kFail, kUncertain,
/// kPass in this order; nothing where nothing was judged.
[[nodiscard]] std::optional<Verdict> worst_verdict(std::span<const Verdict> verdicts) noexcept;

/// "pass", "fail", "invalid", "uncertain".
[[nodiscard]] std::string_view verdict_name(Verdict verdict) noexcept;
[[nodiscard]] std::optional<Verdict> verdict_from_name(std::string_view name) noexcept;

}  // namespace fvd
