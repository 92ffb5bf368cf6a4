#include "daemon/study/study_draft.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/base/units.hpp"
#include "daemon/export/gsf.hpp"

namespace fvd {

void StudyDraft::figure(const std::string& name, double value, const std::string& unit, std::optional<double> u,
                        double k) {
  StudyFigure made{.name = name, .unit = unit};
  if (std::isfinite(value)) {
    made.value = value;
  } else {
    made.reason = "it is not finite";
  }
  if (made.value && u && std::isfinite(*u) && *u > 0.0) {
    made.u = *u;
    made.expanded_u = k * *u;
    made.k = k;
  }
  study.figures.push_back(std::move(made));
}

void StudyDraft::figure(const std::string& name, const std::optional<double>& value, const std::string& unit,
                        const std::string& reason) {
  if (value) return figure(name, *value, unit);
  study.figures.push_back({.name = name, .unit = unit, .reason = reason});
}

StudyMap study_map(const Plane<float>& um, const metrology::HeightField& like, const std::string& title, bool errors) {
  return {metres_of_um(um), like.pitch_x_um, like.pitch_y_um, title, errors, {}};
}

Calibration proposal_for(const Study& study) {
  Calibration proposal;
  proposal.objective = study.objective;
  return proposal;
}

void refuse_repeated_jobs(const std::vector<std::string>& jobs) {
  std::set<std::string> seen;
  for (const std::string& job : jobs) {
    if (!seen.insert(job).second) throw Error(ErrorCode::kStudyRefused, "job " + job + " is given twice");
  }
}

Plane<float> metres_of_um(const Plane<float>& um) {
  Plane<float> metres = Plane<float>::unset(um.width(), um.height());
  std::transform(um.pixels().begin(), um.pixels().end(), metres.pixels().begin(),
                 [](float value) { return static_cast<float>(static_cast<double>(value) * kMetresPerMicrometer); });
  return metres;
}

Plane<float> floats_of(const Plane<double>& values) {
  Plane<float> floats = Plane<float>::unset(values.width(), values.height());
  std::transform(values.pixels().begin(), values.pixels().end(), floats.pixels().begin(),
                 [](double value) { return static_cast<float>(value); });
  return floats;
}

std::string gsf_of_um(const Plane<float>& um, double pitch_x_um, double pitch_y_um, const std::string& title) {
  return encode_gsf(metres_of_um(um),
                    {.title = title, .pitch_x_um = pitch_x_um, .pitch_y_um = pitch_y_um, .metadata = {}});
}

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace fvd
