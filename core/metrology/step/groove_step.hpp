#pragma once

/// The depth of a groove or height of a ridge, ISO 5436-1.

#include <array>
#include <optional>

#include "core/metrology/step/groove_edges.hpp"
#include "core/metrology/step/refusal.hpp"
#include "core/metrology/step/step_height.hpp"

namespace fvd::metrology {

enum class GrooveSign { kGroove, kRidge };

struct GrooveSettings {
  Across across = Across::kX;
  std::optional<FromTo> band;            ///< across the traces; absent = the whole field
  std::optional<FromTo> search;          ///< along the traces, where edges are looked for; absent = everywhere
  std::optional<GrooveEdges> edges;      ///< given instead of found
  int traces = 9;                        ///< 5 or more; the band is shared among them in strips of equal width
  std::optional<double> trace_width_um;  ///< of a strip; absent = the whole share
  double min_valid_fraction = 0.7;       ///< of each region, in each trace and in the band
};

struct GrooveStep {
  GrooveSign sign = GrooveSign::kGroove;
  GrooveEdges edges;
  bool edges_given = false;
  StepTraces traces;
  StepValue mean;                     ///< mean of the traces: the value by the standard
  StepValue areal;                    ///< joint plane over the band
  std::array<StepRegion, 3> regions;  ///< A, B, C over the band
  double plain_means_um = 0.0;        ///< (mean A + mean B) / 2 - mean C, without slope; a comparison only
  double correlation_factor = 1.0;    ///< of the areal form, see JointLevels
};

/// iso5436_a1. Each trace: least squares z = a x + b + h delta, delta = +1 on A and B, -1 on C, height 2 h / sqrt(1 +
/// a^2); a strip of several rows has a slope b across as well, so that holes do no harm. Areal: z = a x + b y + c + h
/// delta over the band, 2 h / sqrt(1 + a^2 + b^2). Heights are positive for groove and ridge. A trace in which a region
/// has too few points is left out; under five are refused. Throws Error(kBadInput) for under five traces asked for or a
/// settings' range that is empty. ISO 5436-1:2000, 7.1; the areal form is its own definition. context: pure.
[[nodiscard]] StepOutcome<GrooveStep> iso5436_a1(const HeightField& field, const GrooveSettings& settings);

enum class BottomForm { kCircle, kParabola };

struct RoundedGroove {
  GrooveSign sign = GrooveSign::kGroove;
  GrooveEdges edges;
  bool edges_given = false;
  BottomForm form = BottomForm::kCircle;
  StepTraces traces;
  StepValue mean;
  std::array<StepRegion, 3> regions;
  double radius_um = 0.0;  ///< of curvature at the vertex, mean of the traces
};

/// iso5436_a2: the rounded bottom. The line through A and B, and the vertex of a circle or parabola through C (least
/// squares along z); the height is the distance of the vertex from the line, perpendicular to it. Refused as
/// kNotRounded where a trace has no vertex within C on the bottom's side. ISO 5436-1:2000, 7.1 (type A2); errors as
/// above.
[[nodiscard]] StepOutcome<RoundedGroove> iso5436_a2(const HeightField& field, const GrooveSettings& settings,
                                                    BottomForm form = BottomForm::kCircle);

}  // namespace fvd::metrology
