#include "daemon/report/section_title.hpp"

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/value_rows.hpp"
#include "daemon/report/verdict_sign.hpp"

namespace fvd {

std::string section_title(const std::string& name, const CrossSection& section) {
  const std::string width = fixed_text(section.band_width_um, section.band_width_um < 10.0 ? 1 : 0);
  return name + (section.band_width_um > 0.0 ? ": mean over " + width + " µm" : std::string());
}

std::string measurement_text(const EvaluatedMeasurement& measurement) {
  Result alone;
  alone.evaluation.emplace();
  alone.evaluation->order = {"it"};
  alone.evaluation->measurements["it"] = measurement;
  const ValueRow main = value_rows(alone).front();
  std::string text = measurement.kind;
  if (!main.name.empty()) text += ", " + main.name + " " + main.value;
  const std::string unit = main.unit.empty() ? std::string() : " " + main.unit;
  if (main.uncertainty != "-") text += " ± " + main.uncertainty.substr(0, main.uncertainty.find("  (k"));
  if (main.value != "-") text += unit;
  if (!main.limits.empty()) text += ", limits " + main.limits + unit;
  if (main.verdict) text += std::string(", ") + verdict_word(*main.verdict);
  if (measurement.verdict && measurement.verdict != main.verdict) {
    text += std::string("; all values ") + verdict_word(*measurement.verdict);
  }
  const std::string reason = measurement.reason.empty() ? main.reason : with_micro_sign(measurement.reason);
  return reason.empty() ? text : text + ": " + reason;
}

}  // namespace fvd
