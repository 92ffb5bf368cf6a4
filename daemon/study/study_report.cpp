#include "daemon/study/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/export/json_values.hpp"

namespace fvd {

namespace {

constexpr std::size_t kShownDigits = 12;
constexpr std::size_t kShownJobs = 6;

std::string unit_text(const std::string& unit) {
  if (unit == "1") return "";
  if (unit == "um") return "µm";
  if (unit == "deg") return "°";
  if (unit == "um/mm") return "µm/mm";
  if (unit == "px/um") return "px/µm";
  return unit;
}

std::string fixed_text(double value, int decimals) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// So many decimals that an uncertainty has two digits.
int decimals_of(double uncertainty) {
  constexpr int kMost = 12;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, kMost);
}

/// "2026-11-29 20:15:00 UTC" of "2026-11-29T20:15:00.000Z".
std::string time_text(const std::string& time) {
  constexpr std::size_t kDay = 10;
  constexpr std::size_t kSeconds = 19;
  if (time.size() < kSeconds || time[kDay] != 'T') return time;
  return time.substr(0, kDay) + " " + time.substr(kDay + 1, kSeconds - kDay - 1) + " UTC";
}

StudyRow row_of(const StudyFigure& figure) {
  StudyRow row{figure.name, "-", "-", unit_text(figure.unit), figure.reason};
  if (figure.value) row.value = number_text(*figure.value);
  if (!figure.expanded_u || !figure.k || !(*figure.expanded_u > 0.0)) return row;
  const int decimals = decimals_of(*figure.expanded_u);
  row.uncertainty = fixed_text(*figure.expanded_u, decimals) + "  (" + fixed_text(*figure.k, 2) + ")";
  if (figure.value) row.value = fixed_text(*figure.value, decimals);
  return row;
}

std::string jobs_text(const std::vector<std::string>& jobs) {
  std::string text;
  for (std::size_t i = 0; i < jobs.size() && i < kShownJobs; ++i) text += (i == 0 ? "" : ", ") + jobs[i];
  if (jobs.size() > kShownJobs) text += " and " + std::to_string(jobs.size() - kShownJobs) + " more";
  return text;
}

std::string value_text(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_array()) return std::to_string(value.size());
  return value.is_number_float() ? number_text(value.get<double>()) : value.dump();
}

/// "tolerance 1, region.rectangle_um.x 5": what is not empty. Jobs have a note of their own, lists are counted.
void add_parameters(const nlohmann::json& object, const std::string& within, std::string& text) {
  for (const auto& [name, value] : object.items()) {
    const bool is_job = name == "job" || name == "jobs" || name == "second_job" || name == "up" || name == "down";
    if (is_job || value.is_null() || value == "" || value == false) continue;
    if (value.is_object()) {
      add_parameters(value, within + name + ".", text);
    } else {
      text += (text.empty() ? "" : ", ") + within + name + " " + value_text(value);
    }
  }
}

std::string parameters_text(const std::string& inputs) {
  std::string text;
  add_parameters(nlohmann::json::parse(inputs, nullptr, false), "", text);
  return text;
}

std::string recipe_text(const Study& study) {
  if (study.recipe_id.empty()) return "several";
  if (study.recipe_sha256.empty()) return study.recipe_id;
  return study.recipe_id + "  " + study.recipe_sha256.substr(0, kShownDigits);
}

std::string subtitle_of(const Study& study) {
  if (study.proposal) return "Adjustment by ISO 25178-700: proposed constants, not valid before they are accepted";
  if (study.kind.starts_with("gauge.")) return "Capability of the measuring system";
  return "Verification by ISO 25178-700, of metrological characteristics by ISO 25178-600";
}

}  // namespace

std::string study_title(const std::string& kind) {
  const std::string what = kind.substr(kind.find('.') + 1);
  if (what == "noise") return "Measurement noise N_M";
  if (what == "flatness") return "Flatness deviation z_FLT";
  if (what == "step" || what == "z") return "Amplification alpha_z and linearity l_z";
  if (what == "linearity") return "Linearity deviation l_z over the range";
  if (what == "lateral") return "Lateral scale and mapping deviations";
  if (what == "resolution") return "Topographic spatial resolution W_R";
  if (what == "sphere") return "Probing errors on a sphere";
  if (what == "hysteresis") return "Hysteresis between up and down";
  if (what == "texture") return "Reproducibility of texture values";
  if (what == "type1") return "Gauge study, type 1";
  if (what == "rr") return "Gauge repeatability and reproducibility";
  if (what == "capability") return "Capability by VDA 5, ISO 22514-7";
  return kind;
}

StudyPage study_page(StudyDraft& draft) {
  const Study& study = draft.study;
  StudyPage page;
  page.title = study_title(study.kind);
  page.subtitle = subtitle_of(study);
  page.simulated = study.simulated;
  page.software_version = study.software_version;
  page.map = std::move(draft.map);
  page.plot = std::move(draft.plot);
  for (const StudyFigure& figure : study.figures) page.rows.push_back(row_of(figure));
  page.facts = {{"Study", ""},
                {"Time", ""},
                {"Method", study.kind},
                {"Person", study.person},
                {"Recipe", recipe_text(study)},
                {"Objective", study.objective}};
  for (const StudyWarning& refusal : study.refusals) page.notes.emplace_back("refused", refusal.text);
  for (const StudyWarning& warning : study.warnings) page.notes.emplace_back("warning", warning.text);
  const std::string parameters = parameters_text(study.inputs);
  if (!parameters.empty()) page.notes.emplace_back("parameters", parameters);
  if (!study.jobs.empty()) page.notes.emplace_back("jobs", jobs_text(study.jobs));
  return page;
}

void set_identity(const Study& study, StudyPage& page) {
  page.facts[0].second = study.id;
  page.facts[1].second = time_text(study.time);
  page.foot = study.id;
  if (const auto time = from_iso8601_utc(study.time)) page.created = *time;
}

}  // namespace fvd
