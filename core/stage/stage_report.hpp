#pragma once

/// The accuracy of the stage in the figures a metrologist asks for. These are figures of the stage scale, measured by
/// its own feedback against its command; the alpha_z and l_z of the instrument (measured against a certified step
/// height) are other numbers. Terms: ISO 25178-600:2019 (amplification coefficient, linearity deviation), ISO
/// 230-2:2014 (reversal value, repeatability).

#include <optional>
#include <string>
#include <vector>

#include "core/stage/position_response.hpp"
#include "core/stage/stage_fit.hpp"
#include "core/stage/stage_point.hpp"

namespace fvd {

/// Statistics of signed differences.
struct ErrorFigures {
  double mean_um = 0.0;
  std::optional<double> sd_um;  ///< sample standard deviation, needs two values
  double max_um = 0.0;          ///< largest magnitude
  double p95_um = 0.0;          ///< 95th percentile of the magnitude
};

/// Straight line through measured over quantised positions, without the other terms of StageFit: drift, reversal and
/// lead error remain in it.
struct LinearFit {
  Estimate alpha_z;                          ///< slope; the lead error can bias it, see StageFit::alpha_z
  double offset_um = 0.0;                    ///< measured position where the line passes z = 0
  double l_z_um = 0.0;                       ///< linearity deviation: largest |mean response of a position - line|
  double residual_rms_um = 0.0;              ///< root of the sum of squares over the number of points
  std::optional<double> alpha_z_bias_bound;  ///< largest bias of alpha_z by the fitted lead error
};

struct TimeFigures {
  double p50_ms = 0.0;
  double p95_ms = 0.0;
  double max_ms = 0.0;
};

struct Span {
  double low = 0.0;
  double high = 0.0;
};

/// A figure is empty if it is not observable or has too few points; `caveats` says why.
struct StageReport {
  int n = 0;  ///< number of points
  FeedbackSource feedback = FeedbackSource::kNone;
  bool observable = false;  ///< false: step counting, no measured position

  std::optional<Span> range_um;       ///< of the quantised positions
  std::optional<Span> temperature_c;  ///< of the points that have one
  std::optional<double> duration_min;

  std::optional<ErrorFigures> error;             ///< measured - quantised: the stage
  std::optional<ErrorFigures> error_to_command;  ///< measured - commanded: stage and quantisation
  std::optional<ErrorFigures> quantisation;      ///< quantised - commanded; needs no feedback
  std::optional<ErrorFigures> increment_error;   ///< of one step, within a run and direction, in order of time

  std::optional<LinearFit> linear;
  std::optional<StageFit> fit;
  std::optional<ReversalFigures> reversal;            ///< drift removed
  std::optional<RepeatabilityFigures> repeatability;  ///< drift removed

  std::optional<TimeFigures> settle;
  std::optional<TimeFigures> move;

  /// Uncertainty floors: standard uncertainty of rounding to one step, step / sqrt(12), by the rectangular distribution
  /// of JCGM 100:2008 (GUM), F.2.2.1. Empty if the step is unknown.
  std::optional<double> step_quantum_um, step_quantum_floor_um;
  std::optional<double> feedback_resolution_um, feedback_floor_um;

  std::vector<std::string> caveats;  ///< limits of the figures, as sentences in English
};

/// points: in any order, may be empty. Throws Error kBadInput as check_stage_points(). context: pure.
[[nodiscard]] StageReport make_stage_report(const std::vector<StagePoint>& points, const StageReportOptions& options);

}  // namespace fvd
