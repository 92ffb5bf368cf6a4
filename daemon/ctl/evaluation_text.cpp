#include "daemon/ctl/evaluation_text.hpp"

#include <iomanip>
#include <sstream>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/result/value_digits.hpp"

namespace fvd::ctl {

namespace {

constexpr int kNameWidth = 20;

std::string limits_text(const Limits& limits) {
  std::ostringstream text;
  if (limits.lower) text << ", at least " << *limits.lower;
  if (limits.upper) text << ", at most " << *limits.upper;
  return text.str();
}

std::string value_text(const std::string& key, const EvaluatedValue& value) {
  if (!value.value) return "-  (" + value.reason + ")";
  const int digits = digits_behind_point(key, value);
  std::string text = fixed_digits(*value.value, digits);
  if (value.expanded_u) text += " +- " + fixed_digits(*value.expanded_u, digits);
  if (value.unit != "1") text += " " + value.unit;
  return text;
}

void add_value(const std::string& key, const EvaluatedValue& value, std::ostringstream& text) {
  text << "  " << std::left << std::setw(kNameWidth) << key << value_text(key, value);
  if (value.limits) text << limits_text(*value.limits);
  if (value.verdict) text << ": " << verdict_name(*value.verdict);
  text << "\n";
  for (const EvaluationWarning& warning : value.warnings) text << "    warning: " << warning.text << "\n";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void add_measurement(const std::string& name, const EvaluatedMeasurement& made, std::ostringstream& text) {
  text << name << "  " << made.kind << (made.method.empty() ? "" : " " + made.method) << " on " << made.surface;
  if (!made.region.empty()) text << ", region " << made.region;
  text << ", " << made.points << " points";
  if (made.verdict) text << ": " << verdict_name(*made.verdict);
  text << "\n";
  if (!made.reason.empty()) text << "  invalid: " << made.reason << "\n";
  for (const auto& [key, value] : made.values) add_value(key, value, text);
  for (const EvaluationWarning& warning : made.warnings) text << "  warning: " << warning.text << "\n";
  if (!made.not_evaluated.empty()) text << "  U does not contain: " << joined(made.not_evaluated) << "\n";
}

}  // namespace

std::string evaluation_text(const Evaluation& evaluation) {
  std::ostringstream text;
  for (const std::string& name : evaluation.order) {
    const auto found = evaluation.measurements.find(name);
    if (found != evaluation.measurements.end()) add_measurement(name, found->second, text);
  }
  return text.str();
}

int exit_code_of(std::optional<Verdict> verdict) noexcept {
  switch (verdict.value_or(Verdict::kPass)) {
    case Verdict::kPass:
      return kExitOk;
    case Verdict::kFail:
      return kExitVerdictFail;
    case Verdict::kUncertain:
      return kExitVerdictUncertain;
    case Verdict::kInvalid:
      return kExitVerdictInvalid;
  }
  return kExitInternal;
}

}  // namespace fvd::ctl
