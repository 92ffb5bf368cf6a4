#pragma once

/// A study that is not kept yet: its figures, its files, and what its page shows.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/height_field.hpp"
#include "core/metrology/study/noise_study.hpp"
#include "daemon/report/study_page.hpp"
#include "daemon/study/study.hpp"

namespace fvd {

struct StudyFile {
  std::string name;
  std::string bytes;
};

struct StudyDraft {
  Study study;  ///< without id and time
  std::vector<StudyFile> files;
  std::optional<StudyMap> map;
  std::optional<StudyPlot> plot;

  void figure(const std::string& name, double value, const std::string& unit, std::optional<double> u = {},
              double k = 2.0);
  /// A number that is not there has a reason in its place.
  void figure(const std::string& name, const std::optional<double>& value, const std::string& unit,
              const std::string& reason);
  void warn(const std::string& code, const std::string& text) { study.warnings.push_back({code, text}); }
};

/// The outcome, or Error kStudyRefused with the sentence of its refusal.
template <typename T>
[[nodiscard]] T accepted(metrology::StudyOutcome<T> outcome) {
  if (auto* made = std::get_if<T>(&outcome)) return std::move(*made);
  throw Error(ErrorCode::kStudyRefused, std::get<metrology::StudyRefusal>(outcome).text);
}

/// The bytes of a map as GSF. um: NaN = hole.
[[nodiscard]] std::string gsf_of_um(const Plane<float>& um, double pitch_x_um, double pitch_y_um,
                                    const std::string& title);
/// The same map for the page, of the field it was made from.
[[nodiscard]] StudyMap study_map(const Plane<float>& um, const metrology::HeightField& like, const std::string& title,
                                 bool errors);
/// Of the study's objective, without constants.
[[nodiscard]] Calibration proposal_for(const Study& study);
/// Throws Error kStudyRefused where one job stands twice: it would look like two that agree.
void refuse_repeated_jobs(const std::vector<std::string>& jobs);

[[nodiscard]] Plane<float> metres_of_um(const Plane<float>& um);
[[nodiscard]] Plane<float> floats_of(const Plane<double>& values);

/// "0.0123", six significant digits.
[[nodiscard]] std::string number_text(double value);

}  // namespace fvd
