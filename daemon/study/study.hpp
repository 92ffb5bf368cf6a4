#pragma once

/// What several jobs say together of the instrument: figures, warnings, and constants that are proposed.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "daemon/result/calibration.hpp"

namespace fvd {

/// One number of a study. Words of ISO 25178-600 and -700.
struct StudyFigure {
  std::string name;                  ///< unique in the study, with its unit: "noise_um"
  std::optional<double> value = {};  ///< absent = cannot be given, see reason
  std::string unit = {};             ///< "um", "%", "deg", "1", ...
  std::optional<double> u = {};      ///< standard uncertainty; absent = not known
  std::optional<double> expanded_u = {};
  std::optional<double> k = {};
  std::string reason = {};  ///< why there is no value
  bool operator==(const StudyFigure&) const = default;
};

/// What one job, or several of one artefact, brought to a study.
struct StudyValue {
  std::string job;   ///< the first of them
  std::string name;  ///< "step.height_um"
  double value = 0.0;
  std::optional<double> u;          ///< standard uncertainty
  std::optional<double> reference;  ///< what it was compared with
  std::optional<double> deviation;
  bool operator==(const StudyValue&) const = default;
};

struct StudyWarning {
  std::string code;  ///< stable, for programs
  std::string text;  ///< for people
  bool operator==(const StudyWarning&) const = default;
};

/// Never changed once it is there.
struct Study {
  static constexpr int kFormat = 1;  ///< of study.json

  int format = kFormat;
  std::string id;         ///< "study-0007"
  std::string kind;       ///< "verify.noise", "calibrate.z", "gauge.rr", ...
  std::string time;       ///< UTC, "2026-11-29T20:15:00.000Z"
  std::string person;     ///< who asked for it; empty = nobody said
  std::string objective;  ///< that the jobs were measured with; empty = none is named
  std::string software_version;
  bool simulated = false;         ///< one of the jobs at least
  std::vector<std::string> jobs;  ///< their identifiers, in the order given
  std::string recipe_id;          ///< the recipe of the jobs, or the one they were evaluated anew with
  std::string recipe_sha256;      ///< likewise; empty where the jobs differ
  std::string inputs = "{}";      ///< JSON object: the parameters as given
  std::vector<StudyFigure> figures;
  std::vector<StudyValue> values;
  std::vector<StudyWarning> warnings;
  std::vector<StudyWarning> refusals;   ///< parts that could not be given, and why; such constants are not accepted
  std::vector<std::string> files;       ///< beside study.json
  std::optional<Calibration> proposal;  ///< calibrate: the constants that calibrate.accept makes valid

  [[nodiscard]] const StudyFigure* find(std::string_view name) const noexcept;
  bool operator==(const Study&) const = default;
};

/// Written and read back by config/field_writer.hpp and field_reader.hpp.
void describe(Study& study, Fields& fields);

/// The text of study.json.
[[nodiscard]] std::string study_json_text(Study study);
/// Throws Error kBadInput with the place of what is wrong.
[[nodiscard]] Study read_study_json(std::string_view text, const std::string& place);

}  // namespace fvd
