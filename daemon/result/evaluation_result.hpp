#pragma once

/// What was measured on a surface as the recipe's section "evaluation" says.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/fields.hpp"
#include "core/surface/verdict.hpp"
#include "daemon/result/cross_section.hpp"

namespace fvd {

/// Reasons of verdicts, by their numbers on the wire (the error codes of daemon/README.md).
namespace evaluation_code {
inline constexpr int kTooFewValid = 1122;
inline constexpr int kInvalid = 1141;             ///< a measurement is invalid for another reason
inline constexpr int kRegionOutside = 1142;       ///< what it looks at does not lie in the field of view
inline constexpr int kCalibrationMissing = 1143;  ///< a surface needs constants of the instrument that there are not
inline constexpr int kUncertain = 1145;           ///< information: a verdict is uncertain
}  // namespace evaluation_code

/// One line of an uncertainty budget, in the unit of its value.
struct UncertaintyLine {
  std::string source;  ///< "noise", "slice_z", "alpha_z", ...
  std::string type;    ///< "A" or "B"
  double u = 0.0;
  std::optional<double> dof;            ///< absent = infinite
  std::optional<double> points_as_one;  ///< noise: so many neighbouring points count as one
  bool operator==(const UncertaintyLine&) const = default;
};

/// Something that lowers trust in a value.
struct EvaluationWarning {
  std::string code;  ///< stable, for programs
  std::string text;  ///< for people
  bool operator==(const EvaluationWarning&) const = default;
};

/// One number, never without its conditions.
struct EvaluatedValue {
  std::optional<double> value;  ///< in `unit`; absent = cannot be given, see reason
  std::string unit;             ///< "um", "%", "deg", "1", "um/um", "ml/m^2"
  std::string reason;           ///< why there is no value
  std::optional<double> u;      ///< standard uncertainty; absent = not known
  std::optional<double> expanded_u;
  std::optional<double> k;
  std::optional<double> dof;  ///< absent = infinite, or not known
  std::string u_method;       ///< "linear", "monte_carlo", "jacobian", "spread", "repeated"; empty without u
  std::vector<UncertaintyLine> budget;
  std::optional<Limits> limits;
  std::optional<Verdict> verdict;     ///< present where limits are
  std::optional<double> probability;  ///< of conformity, 0..1
  std::vector<EvaluationWarning> warnings;
  bool operator==(const EvaluatedValue&) const = default;
};

struct EvaluatedMeasurement {
  std::string id;  ///< for PLCs, at most 4 characters
  std::string kind;
  std::string method;
  std::string surface;
  std::string region;
  std::string reason;   ///< why all of it is invalid; empty = it is not
  int reason_code = 0;  ///< of that reason on the wire: evaluation_code; 0 = none
  std::int64_t points = 0;
  double valid_fraction = 0.0;
  std::string main_value;                        ///< the key of the value that stands for the measurement; may be empty
  std::map<std::string, EvaluatedValue> values;  ///< by name with unit, e.g. "height_um"
  std::vector<std::string> not_evaluated;        ///< what no budget above contains
  std::string details;                           ///< JSON object: traces, sections, conditions; empty = none
  std::optional<CrossSection> cross_section;     ///< where it looked, for pictures
  std::vector<EvaluationWarning> warnings;
  std::optional<Verdict> verdict;  ///< the worst of its values'; absent where nothing is limited
  bool operator==(const EvaluatedMeasurement&) const = default;
};

struct Evaluation {
  std::optional<Verdict> verdict;  ///< the worst of the measurements'
  std::string rule;                ///< of the decision
  double probability = 0.95;
  std::string calibration = "none";             ///< the identifier of the calibration that was used
  std::map<std::string, std::string> surfaces;  ///< JSON by name: each surface's steps with what they did
  std::vector<std::string> order;               ///< of the measurements
  std::map<std::string, EvaluatedMeasurement> measurements;
  bool operator==(const Evaluation&) const = default;
};

/// Written and read back by config/field_writer.hpp and field_reader.hpp.
void describe(Evaluation& evaluation, Fields& fields);

}  // namespace fvd
