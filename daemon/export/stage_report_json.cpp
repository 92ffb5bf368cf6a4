#include <nlohmann/json.hpp>

#include "daemon/export/json_values.hpp"
#include "daemon/export/stage_report_files.hpp"

namespace fvd {

namespace {

using Json = nlohmann::ordered_json;

Json um(const std::optional<double>& value) { return rounded(value, 6); }
Json ms(const std::optional<double>& value) { return rounded(value, 3); }
Json slope(const std::optional<double>& value) { return rounded(value, 9); }

std::optional<double> value_of(const std::optional<Estimate>& e) { return e ? std::optional(e->value) : std::nullopt; }
std::optional<double> error_of(const std::optional<Estimate>& e) { return e ? e->standard_error : std::nullopt; }

Json error_figures(const std::optional<ErrorFigures>& f) {
  if (!f) return nullptr;
  return {{"mean_um", um(f->mean_um)}, {"sd_um", um(f->sd_um)}, {"max_um", um(f->max_um)}, {"p95_um", um(f->p95_um)}};
}

Json span(const std::optional<Span>& s, int decimals) {
  if (!s) return nullptr;
  return {{"low", rounded(s->low, decimals)}, {"high", rounded(s->high, decimals)}};
}

Json times(const std::optional<TimeFigures>& t) {
  if (!t) return nullptr;
  return {{"p50_ms", ms(t->p50_ms)}, {"p95_ms", ms(t->p95_ms)}, {"max_ms", ms(t->max_ms)}};
}

Json straight_line(const std::optional<LinearFit>& line) {
  if (!line) return nullptr;
  return {{"alpha_z", slope(line->alpha_z.value)},
          {"alpha_z_standard_error", slope(line->alpha_z.standard_error)},
          {"alpha_z_bias_bound", slope(line->alpha_z_bias_bound)},
          {"offset_um", um(line->offset_um)},
          {"l_z_um", um(line->l_z_um)},
          {"residual_rms_um", um(line->residual_rms_um)}};
}

Json lead_error(const std::optional<LeadTerm>& lead) {
  if (!lead) return nullptr;
  return {{"lead_um", um(lead->lead_um)},
          {"amplitude_um", um(lead->amplitude_um.value)},
          {"amplitude_standard_error_um", um(lead->amplitude_um.standard_error)},
          {"phase_deg", rounded(lead->phase_deg, 3)}};
}

Json joint_fit(const std::optional<StageFit>& fit) {
  if (!fit) return nullptr;
  return {{"alpha_z", slope(value_of(fit->alpha_z))},
          {"alpha_z_standard_error", slope(error_of(fit->alpha_z))},
          {"offset_um", um(fit->offset_um)},
          {"lead_error", lead_error(fit->lead)},
          {"reversal_um", um(value_of(fit->reversal_um))},
          {"reversal_standard_error_um", um(error_of(fit->reversal_um))},
          {"parameters", fit->parameters},
          {"residual_rms_um", um(fit->residual_rms_um)}};
}

Json drift(const std::optional<StageFit>& fit) {
  if (!fit) return nullptr;
  Json json{{"um_per_min", um(value_of(fit->drift_um_per_min))},
            {"um_per_min_standard_error", um(error_of(fit->drift_um_per_min))},
            {"um_per_k", um(value_of(fit->drift_um_per_k))},
            {"um_per_k_standard_error", um(error_of(fit->drift_um_per_k))}};
  json["um_per_k_from_rates"] = fit->drift_um_per_k ? Json(fit->per_kelvin_from_rates) : Json(nullptr);
  return json;
}

Json reversal(const std::optional<ReversalFigures>& f) {
  if (!f) return nullptr;
  return {{"mean_um", um(f->mean_um)}, {"max_um", um(f->max_um)}, {"positions", f->positions}};
}

Json repeatability(const std::optional<RepeatabilityFigures>& f) {
  if (!f) return nullptr;
  return {{"pooled_sd_um", um(f->pooled_sd_um)}, {"max_sd_um", um(f->max_sd_um)}, {"groups", f->groups}};
}

/// What the figures mean: a reader of the file has no header at hand.
Json definitions() {
  return {
      {"error", "measured - quantised; error_to_command: measured - commanded; quantisation: quantised - commanded"},
      {"max", "largest magnitude; p95: 95th percentile of the magnitude"},
      {"alpha_z",
       "slope of measured against quantised position of the stage, 1 = ideal; not the amplification coefficient of the "
       "instrument, which needs a certified step height. Term: ISO 25178-600:2019"},
      {"l_z", "largest deviation of a position's mean response from the straight line. Term: ISO 25178-600:2019"},
      {"lead_error",
       "error = amplitude sin(2 pi z / lead + phase), z = quantised position, phase in (-180, 180] degrees"},
      {"reversal",
       "mean approached from below - mean approached from above, per position, drift removed; ISO 230-2:2014"},
      {"repeatability", "standard deviation s of visits from one side, drift removed; R of ISO 230-2:2014 is 4 s"},
      {"drift",
       "um_per_min beside a fitted um_per_k is what is left at constant temperature; um_per_k_from_rates: um_per_k is "
       "um_per_min over the rate of temperature"},
      {"floor", "step / sqrt(12), the standard uncertainty that rounding alone leaves; JCGM 100:2008 F.2.2.1"},
      {"standard_error", "from the residuals of the fit, taken for independent"}};
}

Json provenance(const StageReport& report, const StageReportHeader& header) {
  Json json{{"profile", text_or_null(header.profile)},
            {"address", text_or_null(header.address)},
            {"date", iso8601_utc(header.date)},
            {"software_version", text_or_null(header.software_version)}};
  if (header.simulated) json["simulated"] = *header.simulated;
  json["feedback"] = feedback_name(report.feedback);
  return json;
}

}  // namespace

std::string stage_report_json(const StageReport& report, const StageReportHeader& header) {
  Json json;
  json["provenance"] = provenance(report, header);
  json["observable"] = report.observable;
  json["caveats"] = report.caveats;
  json["points"] = report.n;
  json["duration_min"] = rounded(report.duration_min, 3);
  json["range_um"] = span(report.range_um, 6);
  json["temperature_c"] = span(report.temperature_c, 3);
  json["error"] = error_figures(report.error);
  json["error_to_command"] = error_figures(report.error_to_command);
  json["quantisation"] = error_figures(report.quantisation);
  json["increment_error"] = error_figures(report.increment_error);
  json["straight_line"] = straight_line(report.linear);
  json["fit"] = joint_fit(report.fit);
  json["reversal"] = reversal(report.reversal);
  json["repeatability"] = repeatability(report.repeatability);
  json["drift"] = drift(report.fit);
  json["settle"] = times(report.settle);
  json["move"] = times(report.move);
  json["step_quantum_um"] = um(report.step_quantum_um);
  json["step_quantum_floor_um"] = um(report.step_quantum_floor_um);
  json["feedback_resolution_um"] = um(report.feedback_resolution_um);
  json["feedback_floor_um"] = um(report.feedback_floor_um);
  json["definitions"] = definitions();
  return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace fvd
