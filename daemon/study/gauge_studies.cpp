/// Studies of a gauge: one part many times, parts by operators by trials, and what both say of a tolerance.

#include <cmath>
#include <map>
#include <numeric>

#include "config/field_reader.hpp"
#include "core/metrology/study/capability.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

constexpr std::size_t kUsualLeast = 25;

template <typename Request>
std::vector<double> values_of(const Request& request, StudyJobs& jobs, StudyDraft& draft, std::string& unit) {
  jobs.note(request.jobs, request.recipe, draft.study);
  std::vector<double> values;
  for (const std::string& id : request.jobs) {
    if (request.require_calibration) jobs.require_calibration(id);
    const JobValue value = jobs.value(id, request.what, request.recipe, Corrected::kAsMeasured);
    if (values.empty()) unit = value.unit;
    if (value.unit != unit || (!draft.study.values.empty() && draft.study.values.front().name != value.name)) {
      throw Error(ErrorCode::kStudyRefused,
                  "job " + id + " gives " + value.name + " where the others give " + draft.study.values.front().name);
    }
    values.push_back(value.value);
    draft.study.values.push_back({id, value.name, value.value, value.u, {}, {}});
  }
  return values;
}

template <typename Request>
Request request_of(const Study& study, const std::string& kind) {
  if (study.kind != kind) {
    throw Error(ErrorCode::kStudyRefused, study.id + " is of the kind " + study.kind + ", not " + kind);
  }
  if (study.values.empty()) throw Error(ErrorCode::kBadInput, study.id + ": /values: has none");
  Request request;
  Problems problems;
  read_document(
      study.inputs, [&request](Fields& fields) { request.describe(fields); }, problems);
  if (problems.empty()) return request;
  throw Error(ErrorCode::kBadInput,
              study.id + ": /inputs" + problems.front().pointer + ": " + problems.front().message);
}

std::vector<double> stored_values(const Study& study) {
  std::vector<double> values;
  for (const StudyValue& value : study.values) values.push_back(value.value);
  return values;
}

metrology::GaugeType1Settings settings_of(const Type1Request& request) {
  metrology::GaugeType1Settings settings;
  settings.reference = request.reference;
  settings.tolerance = request.tolerance;
  settings.tolerance_share = request.tolerance_share;
  settings.spread_sd = request.spread_sd;
  settings.resolution = request.resolution;
  settings.required = request.required;
  return settings;
}

metrology::GaugeRrSettings settings_of(const RrRequest& request) {
  metrology::GaugeRrSettings settings;
  settings.parts = request.parts;
  settings.operators = request.operators;
  settings.trials = request.trials;
  settings.pooling_p = request.pooling_p;
  settings.tolerance = request.tolerance;
  settings.spread_sd = request.spread_sd;
  return settings;
}

void warn_of_type1(const Type1Request& request, const metrology::GaugeType1& gauge, StudyDraft& draft) {
  if (request.jobs.size() < kUsualLeast) {
    draft.warn("few_scans", std::to_string(request.jobs.size()) + " scans; 25 are the usual least number");
  }
  if (gauge.bias_significant) draft.warn("bias", "the bias is significant (p below 0.05)");
  if (gauge.resolution_percent && *gauge.resolution_percent > 5.0) {
    draft.warn("resolution", "the resolution is above 5 % of the tolerance");
  }
  if (!gauge.capable) draft.warn("not_capable", "Cg or Cgk is below " + number_text(request.required));
}

void require_count(const RrRequest& request) {
  const auto wanted = static_cast<std::size_t>(request.parts) * static_cast<std::size_t>(request.operators) *
                      static_cast<std::size_t>(request.trials);
  if (request.jobs.size() == wanted) return;
  throw Error(ErrorCode::kStudyRefused, std::to_string(request.jobs.size()) + " jobs were given, " +
                                            std::to_string(request.parts) + " parts x " +
                                            std::to_string(request.operators) + " operators x " +
                                            std::to_string(request.trials) + " trials are " + std::to_string(wanted));
}

/// Jobs of one group must name one part: the order of the list is easily mistaken.
void warn_of_order(const RrRequest& request, StudyJobs& jobs, StudyDraft& draft) {
  const std::size_t group = request.jobs.size() / static_cast<std::size_t>(request.parts);
  for (std::size_t i = 0; i < request.jobs.size(); ++i) {
    const std::string& part = jobs.result(request.jobs[i]).job.part_id;
    const std::string& first = jobs.result(request.jobs[i - i % group]).job.part_id;
    if (part == first) continue;
    draft.warn("order", "job " + request.jobs[i] + " names the part '" + part + "' where '" + first +
                            "' is expected: jobs go part by part");
    return;
  }
}

void warn_of_rr(const metrology::GaugeRr& gauge, StudyDraft& draft) {
  constexpr double kMost_percent = 30.0;
  constexpr double kGood_percent = 10.0;
  constexpr int kLeastCategories = 5;
  const double percent = gauge.grr_of_tolerance_percent.value_or(gauge.grr_of_total_percent.value_or(0.0));
  if (percent > kMost_percent) {
    draft.warn("not_capable", "%GRR is above 30");
  } else if (percent > kGood_percent) {
    draft.warn("conditionally_capable", "%GRR is between 10 and 30");
  }
  if (gauge.ndc && *gauge.ndc < kLeastCategories) draft.warn("ndc", "fewer than 5 categories are told apart");
}

void plot_values(const std::vector<double>& values, double from, const std::string& unit, StudyDraft& draft) {
  StudyPlot plot{"values in the order given",
                 "number",
                 "value less " + number_text(from) + " / " + (unit == "um" ? "µm" : unit),
                 {}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    plot.points.push_back({static_cast<double>(i) + 1.0, values[i] - from, {}});
  }
  draft.plot = std::move(plot);
}

}  // namespace

Type1Request type1_request_of(const Study& study) { return request_of<Type1Request>(study, "gauge.type1"); }
RrRequest rr_request_of(const Study& study) { return request_of<RrRequest>(study, "gauge.rr"); }

StudyDraft type1_study(const Type1Request& request, StudyJobs& jobs) {
  if (request.jobs.size() < 2) throw Error(ErrorCode::kStudyRefused, "a type 1 study needs 2 scans, better 25");
  StudyDraft draft;
  std::string unit;
  const std::vector<double> values = values_of(request, jobs, draft, unit);
  const metrology::GaugeType1 gauge = metrology::gauge_type1(values, settings_of(request));
  const char* const no_spread = "the values do not differ";
  draft.figure("n", gauge.n, "1");
  draft.figure("mean", gauge.mean, unit, gauge.sd / std::sqrt(static_cast<double>(gauge.n)));
  draft.figure("bias", gauge.bias, unit);
  draft.figure("sd", gauge.sd, unit);
  draft.figure("Cg", gauge.cg, "1", no_spread);
  draft.figure("Cgk", gauge.cgk, "1", no_spread);
  draft.figure("t", gauge.t, "1", no_spread);
  draft.figure("p_value", gauge.p_value, "1", no_spread);
  draft.figure("resolution_percent", gauge.resolution_percent, "%", "no resolution was given");
  draft.figure("capable", gauge.capable ? 1.0 : 0.0, "1");
  for (StudyValue& value : draft.study.values) {
    value.reference = request.reference;
    value.deviation = value.value - request.reference;
  }
  warn_of_type1(request, gauge, draft);
  plot_values(values, request.reference, unit, draft);
  return draft;
}

StudyDraft rr_study(const RrRequest& request, StudyJobs& jobs) {
  require_count(request);
  StudyDraft draft;
  std::string unit;
  const std::vector<double> values = values_of(request, jobs, draft, unit);
  warn_of_order(request, jobs, draft);
  const metrology::GaugeRr gauge = metrology::gauge_rr(values, settings_of(request));
  draft.figure("EV", gauge.ev, unit);
  draft.figure("AV", gauge.av, unit);
  draft.figure("INT", gauge.interaction, unit);
  draft.figure("GRR", gauge.grr, unit);
  draft.figure("PV", gauge.pv, unit);
  draft.figure("TV", gauge.tv, unit);
  draft.figure("grr_of_tolerance_percent", gauge.grr_of_tolerance_percent, "%", "no tolerance was given");
  draft.figure("grr_of_total_percent", gauge.grr_of_total_percent, "%", "the values do not differ");
  draft.figure("ndc", gauge.ndc ? std::optional(static_cast<double>(*gauge.ndc)) : std::nullopt, "1",
               "the gauge has no spread");
  draft.figure("interaction_pooled", gauge.interaction_pooled ? 1.0 : 0.0, "1");
  draft.figure("interaction_p", gauge.interaction_p, "1", "one operator");
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (StudyValue& value : draft.study.values) value.deviation = value.value - mean;
  warn_of_rr(gauge, draft);
  plot_values(values, mean, unit, draft);
  return draft;
}

StudyDraft capability_study(const CapabilityRequest& request, const Study& type1, const Study& rr) {
  const Type1Request type1_request = type1_request_of(type1);
  const RrRequest rr_request = rr_request_of(rr);
  const std::string& name = type1.values.front().name;
  if (rr.values.front().name != name || type1.recipe_id != rr.recipe_id || type1.objective != rr.objective) {
    throw Error(ErrorCode::kStudyRefused, type1.id + " is of " + name + ", recipe '" + type1.recipe_id +
                                              "', objective '" + type1.objective + "'; " + rr.id + " of " +
                                              rr.values.front().name + ", recipe '" + rr.recipe_id + "', objective '" +
                                              rr.objective + "'");
  }
  StudyDraft draft;
  draft.study.objective = type1.objective;
  draft.study.recipe_id = type1.recipe_id;
  if (type1.recipe_sha256 == rr.recipe_sha256) draft.study.recipe_sha256 = type1.recipe_sha256;
  draft.study.simulated = type1.simulated || rr.simulated;
  metrology::CapabilityInputs inputs;
  inputs.calibration = request.u_calibration;
  inputs.linearity = request.u_linearity;
  inputs.stability = request.u_stability;
  inputs.object = request.u_object;
  inputs.temperature = request.u_temperature;
  inputs.rest_system = request.u_rest_system;
  inputs.rest_process = request.u_rest_process;
  inputs.tolerance = request.tolerance.value_or(type1_request.tolerance);
  inputs.k = request.k;
  const metrology::Capability found = metrology::capability(
      metrology::gauge_type1(stored_values(type1), settings_of(type1_request)), type1_request.resolution,
      metrology::gauge_rr(stored_values(rr), settings_of(rr_request)), inputs);
  const StudyFigure* const sd = type1.find("sd");
  const std::string unit = sd != nullptr ? sd->unit : std::string();
  draft.figure("Q_MS_percent", found.q_system_percent, "%");
  draft.figure("Q_MP_percent", found.q_process_percent, "%");
  draft.figure("u_MS", found.u_system, unit);
  draft.figure("u_MP", found.u_process, unit);
  draft.figure("tolerance", inputs.tolerance, unit);
  draft.figure("system_capable", found.system_capable ? 1.0 : 0.0, "1");
  draft.figure("process_capable", found.process_capable ? 1.0 : 0.0, "1");
  if (!found.system_capable) draft.warn("system_not_capable", "Q_MS is above 15 %");
  if (!found.process_capable) draft.warn("process_not_capable", "Q_MP is above 30 %");
  if (request.u_calibration == 0.0) {
    draft.warn("no_calibration_uncertainty", "u_calibration is 0: the reference is taken to be known without error");
  }
  return draft;
}

std::optional<GaugeRepeatability> repeatability_of(const Study& study) {
  if (study.values.empty()) return std::nullopt;
  const auto value_of = [&study](const char* name) {
    const StudyFigure* figure = study.find(name);
    return figure != nullptr ? figure->value : std::nullopt;
  };
  if (study.kind == "gauge.type1") {
    const auto sd = value_of("sd");
    if (!sd) return std::nullopt;
    return GaugeRepeatability{study.values.front().name, *sd, static_cast<double>(study.values.size()) - 1.0};
  }
  if (study.kind != "gauge.rr") return std::nullopt;
  const auto ev = value_of("EV");
  if (!ev) return std::nullopt;
  const RrRequest request = rr_request_of(study);
  double dof = static_cast<double>(request.parts) * request.operators * (request.trials - 1.0);
  if (value_of("interaction_pooled").value_or(0.0) != 0.0) dof += (request.parts - 1.0) * (request.operators - 1.0);
  return GaugeRepeatability{study.values.front().name, *ev, dof};
}

StudyDraft texture_study(const TextureRequest& request, Purpose purpose, StudyJobs& jobs) {
  constexpr std::size_t kMost = 200;
  constexpr std::size_t kUsualPlacements = 10;
  if (request.jobs.size() < 2 || request.jobs.size() > kMost) {
    throw Error(ErrorCode::kStudyRefused,
                std::to_string(request.jobs.size()) + " jobs were given, 2 to 200 make this study");
  }
  refuse_repeated_jobs(request.jobs);
  StudyDraft draft;
  std::string unit;
  const std::vector<double> values = values_of(request, jobs, draft, unit);
  if (!jobs.of_one_part(request.jobs)) {
    draft.warn("parts_differ", "the jobs name different parts; reproducibility is that of one surface");
  }
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double sd = std::sqrt(squares / (n - 1.0));
  const std::string name = draft.study.values.front().name;
  constexpr double kFarFromZero = 2.0;
  if (!(std::abs(mean) > kFarFromZero * sd)) {
    throw Error(ErrorCode::kStudyRefused, name + " scatters by " + number_text(sd) + " about " + number_text(mean) +
                                              ": a share in percent of a value so near to 0 says nothing");
  }
  const double percent = 100.0 * sd / std::abs(mean);
  draft.figure("reproducibility_percent", percent, "%", percent / std::sqrt(2.0 * (n - 1.0)));
  draft.figure("mean", mean, unit, sd / std::sqrt(n));
  draft.figure("sd", sd, unit);
  draft.figure("scans", n, "1");
  if (values.size() < kUsualPlacements) {
    draft.warn("few_scans", std::to_string(values.size()) + " scans; 10 are the usual least number");
  }
  plot_values(values, mean, unit, draft);
  if (purpose == Purpose::kCalibrate) {
    draft.study.proposal = proposal_for(draft.study);
    draft.study.proposal->texture = TextureConstants{percent, {}};
  }
  return draft;
}

}  // namespace fvd
