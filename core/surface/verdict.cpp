#include "core/surface/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fvd {
namespace {

/// The first of `order` that is among the verdicts, else kPass; nothing where there are none.
std::optional<Verdict> first_found(std::span<const Verdict> verdicts, const std::array<Verdict, 3>& order) noexcept {
  if (verdicts.empty()) return std::nullopt;
  for (const Verdict worst : order) {
    if (std::find(verdicts.begin(), verdicts.end(), worst) != verdicts.end()) return worst;
  }
  return Verdict::kPass;
}

}  // namespace

Verdict judge(std::optional<double> value, const Limits& limits) noexcept {
  if (!value || !std::isfinite(*value)) return Verdict::kInvalid;
  const bool below = limits.lower && *value < *limits.lower;
  const bool above = limits.upper && *value > *limits.upper;
  return below || above ? Verdict::kFail : Verdict::kPass;
}

std::optional<Verdict> joined_verdict(std::span<const Verdict> verdicts) noexcept {
  return first_found(verdicts, {Verdict::kFail, Verdict::kInvalid, Verdict::kUncertain});
}

std::optional<Verdict> worst_verdict(std::span<const Verdict> verdicts) noexcept {
  return first_found(verdicts, {Verdict::kInvalid, Verdict::kFail, Verdict::kUncertain});
}

std::string_view verdict_name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kFail:
      return "fail";
    case Verdict::kUncertain:
      return "uncertain";
    case Verdict::kInvalid:
      break;
  }
  return "invalid";
}

std::optional<Verdict> verdict_from_name(std::string_view name) noexcept {
  for (const Verdict verdict : std::array{Verdict::kPass, Verdict::kFail, Verdict::kInvalid, Verdict::kUncertain}) {
    if (name == verdict_name(verdict)) return verdict;
  }
  return std::nullopt;
}

}  // namespace fvd
