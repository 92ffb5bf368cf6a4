#include "core/surface/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fvd {

Verdict judge(std::optional<double> value, const Limits& limits) noexcept {
  if (!value || !std::isfinite(*value)) return Verdict::kInvalid;
  const bool below = limits.lower && *value < *limits.lower;
  const bool above = limits.upper && *value > *limits.upper;
  return below || above ? Verdict::kFail : Verdict::kPass;
}

std::optional<Verdict> joined_verdict(std::span<const Verdict> verdicts) noexcept {
  if (verdicts.empty()) return std::nullopt;
  for (const Verdict worst : {Verdict::kFail, Verdict::kInvalid}) {
    if (std::find(verdicts.begin(), verdicts.end(), worst) != verdicts.end()) return worst;
  }
  return Verdict::kPass;
}

std::string_view verdict_name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kFail:
      return "fail";
    case Verdict::kInvalid:
      break;
  }
  return "invalid";
}

std::optional<Verdict> verdict_from_name(std::string_view name) noexcept {
  for (const Verdict verdict : std::array{Verdict::kPass, Verdict::kFail, Verdict::kInvalid}) {
    if (name == verdict_name(verdict)) return verdict;
  }
  return std::nullopt;
}

}  // namespace fvd
