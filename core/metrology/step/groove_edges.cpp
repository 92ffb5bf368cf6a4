#include "core/metrology/step/groove_edges.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

namespace fvd::metrology {
namespace {

constexpr double kStandsOut = 5.0;       // times the differences' scatter
constexpr double kLongestGap = 0.1;      // of the trace
constexpr double kRoundingShare = 1e-9;  // of the trace's range: differences below are no scatter, but rounding
constexpr double kNormalMad = 1.4826;    // scatter of a normal distribution over its median absolute deviation

/// Index 0 at the middle of the trace's first pair of points; `deviation` less than all others' median.
struct Differences {
  std::vector<double> deviation;  // NaN where a point of the pair is missing
  double scatter = 0.0;
};

struct Flank {
  double peak = 0.0;    // positive, the steepest difference's deviation
  double centre = 0.0;  // index of difference
};

/// values is reordered.
double median_of(std::vector<double>& values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// The rise over a short gap is shared evenly along it. Only the search for edges sees that, never a height.
std::vector<double> bridged(const std::vector<double>& trace) {
  std::vector<double> result = trace;
  const auto longest = static_cast<std::size_t>(kLongestGap * static_cast<double>(trace.size()));
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (std::isnan(trace[i])) continue;
    if (before.has_value() && i - *before > 1 && i - *before - 1 <= longest) {
      const double step = (trace[i] - trace[*before]) / static_cast<double>(i - *before);
      for (std::size_t j = *before + 1; j < i; ++j) {
        result[j] = trace[*before] + step * static_cast<double>(j - *before);
      }
    }
    before = i;
  }
  return result;
}

std::optional<Differences> differences_of(const std::vector<double>& trace, std::size_t lag) {
  if (trace.size() <= lag) return std::nullopt;
  const std::vector<double> heights = bridged(trace);
  Differences differences;
  differences.deviation.resize(heights.size() - lag);
  std::vector<double> present;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (std::size_t i = 0; i < differences.deviation.size(); ++i) {
    differences.deviation[i] = heights[i + lag] - heights[i];
    if (!std::isnan(differences.deviation[i])) present.push_back(differences.deviation[i]);
  }
  for (const double z : trace) {
    if (std::isnan(z)) continue;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  if (present.empty()) return std::nullopt;
  const double median = median_of(present);
  for (double& value : differences.deviation) value -= median;
  for (double& value : present) value = std::abs(value - median);
  differences.scatter = std::max(kNormalMad * median_of(present), kRoundingShare * (highest - lowest));
  return differences;
}

/// Where the deviation falls to half of the peak, from `at` in steps of +1 or -1; at the last one where it never does.
double half_way(const std::vector<double>& deviation, std::size_t at, int step, double sign, double half) {
  std::size_t inside = at;
  while (step > 0 ? inside + 1 < deviation.size() : inside > 0) {
    const std::size_t next = step > 0 ? inside + 1 : inside - 1;
    const double value = sign * deviation[next];
    if (std::isnan(value)) break;
    if (value < half) {
      const double steep = sign * deviation[inside];
      return static_cast<double>(inside) + step * (steep - half) / (steep - value);
    }
    inside = next;
  }
  return static_cast<double>(inside);
}

/// sign: +1 for the steepest rise, -1 for the steepest fall.
Flank steepest(const Differences& differences, double sign) {
  const std::vector<double>& deviation = differences.deviation;
  Flank flank;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < deviation.size(); ++i) {
    const double value = sign * deviation[i];
    if (value > flank.peak) {
      flank.peak = value;
      first = i;
    }
    if (value >= flank.peak && flank.peak > 0.0) last = i;
  }
  if (flank.peak <= 0.0) return flank;
  // Equal peaks, as an ideal wall has them: from the outer ones, or a mirrored trace would have another edge.
  const double half = 0.5 * flank.peak;
  const double from = half_way(deviation, first, -1, sign, half);
  if (half_way(deviation, first, 1, sign, half) < static_cast<double>(last)) last = first;
  flank.centre = 0.5 * (from + half_way(deviation, last, 1, sign, half));
  return flank;
}

}  // namespace

std::array<FromTo, 3> groove_regions(const GrooveEdges& edges) {
  const double width = edges.width_um();
  const double centre = edges.centre_um();
  const double near = width / 2.0 + width / 3.0;
  const double far = 1.5 * width;
  return {{{centre - far, centre - near}, {centre + near, centre + far}, {centre - width / 6.0, centre + width / 6.0}}};
}

std::vector<double> median_trace(const HeightField& field, Across across, int first, int last) {
  const bool along_x = across == Across::kX;
  const int length = along_x ? field.width() : field.height();
  assert(first >= 0 && first <= last && last < (along_x ? field.height() : field.width()));
  std::vector<double> trace(static_cast<std::size_t>(length), std::nan(""));
  std::vector<double> present;
  for (int place = 0; place < length; ++place) {
    present.clear();
    for (int row = first; row <= last; ++row) {
      const double z = along_x ? field.z_um.at(place, row) : field.z_um.at(row, place);
      if (!std::isnan(z)) present.push_back(z);
    }
    if (2 * static_cast<int>(present.size()) < last - first + 1) continue;
    trace[static_cast<std::size_t>(place)] = median_of(present);
  }
  return trace;
}

StepOutcome<GrooveEdges> find_groove_edges(const std::vector<double>& trace, double pitch_um, int lag_points) {
  assert(pitch_um > 0.0 && lag_points >= 1);
  const std::optional<Differences> differences = differences_of(trace, static_cast<std::size_t>(lag_points));
  if (!differences.has_value()) {
    return StepRefusal{StepRefusalCode::kNoEdges, "the trace has no two heights to look for edges in", std::nullopt};
  }
  const Flank rise = steepest(*differences, 1.0);
  const Flank fall = steepest(*differences, -1.0);
  const double weaker = std::min(rise.peak, fall.peak);
  const double asked = kStandsOut * differences->scatter;
  if (weaker <= asked) {
    return StepRefusal{StepRefusalCode::kNoEdges,
                       "no groove or ridge stands out of the trace: its steepest " +
                           std::string(rise.peak <= fall.peak ? "rise" : "fall") + " is " + std::to_string(weaker) +
                           " um, and " + std::to_string(asked) + " um are asked for",
                       std::nullopt};
  }
  // A difference of index i stands in the middle between the points i and i + lag.
  const auto position = [&](const Flank& flank) { return (flank.centre + 0.5 * lag_points + 0.5) * pitch_um; };
  return GrooveEdges{std::min(position(rise), position(fall)), std::max(position(rise), position(fall))};
}

}  // namespace fvd::metrology
