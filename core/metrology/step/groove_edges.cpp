#include "core/metrology/step/groove_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fvd::metrology {

namespace {

constexpr double kMadToDeviation = 1.4826;
constexpr double kStandsOut = 5.0;
constexpr std::size_t kGapShare = 10;  ///< holes of up to a tenth of the trace are bridged
constexpr std::size_t kLeastDifferences = 6;

/// A difference of two heights and the place between them, in points.
struct Difference {
  double place = 0.0;
  double height = 0.0;
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double upper = *middle;
  if (values.size() % 2 == 1) return upper;
  return 0.5 * (upper + *std::max_element(values.begin(), middle));
}

std::vector<Difference> differences_of(const std::vector<double>& trace, std::size_t lag) {
  const std::size_t reach = std::max(lag, trace.size() / kGapShare);
  std::vector<Difference> differences;
  for (std::size_t i = 0; i + lag < trace.size(); ++i) {
    if (std::isnan(trace[i])) continue;
    for (std::size_t j = i + lag; j < trace.size() && j <= i + reach; ++j) {
      if (std::isnan(trace[j])) continue;
      differences.push_back({0.5 * static_cast<double>(i + j + 1), trace[j] - trace[i]});
      break;
    }
  }
  return differences;
}

/// The centre of the run about the largest of sign * height that is at least half as large.
double flank_centre(const std::vector<Difference>& differences, double sign) {
  const auto larger = [sign](const Difference& a, const Difference& b) { return sign * a.height < sign * b.height; };
  const auto top = std::max_element(differences.begin(), differences.end(), larger);
  const double half = 0.5 * sign * top->height;
  auto first = top;
  while (first != differences.begin() && sign * std::prev(first)->height >= half) --first;
  auto last = top;
  while (std::next(last) != differences.end() && sign * std::next(last)->height >= half) ++last;
  return 0.5 * (first->place + last->place);
}

StepRefusal no_edges(const std::string& why) {
  return {StepRefusalCode::kNoEdges, "no groove or ridge stands out of the median trace: " + why, std::nullopt};
}

}  // namespace

std::array<FromTo, 3> groove_regions(const GrooveEdges& edges) {
  const double width = edges.width_um();
  const double centre = edges.centre_um();
  const double near_edge = width / 2.0 + width / 3.0;
  return {FromTo{centre - 1.5 * width, centre - near_edge}, FromTo{centre + near_edge, centre + 1.5 * width},
          FromTo{centre - width / 6.0, centre + width / 6.0}};
}

std::vector<double> median_trace(const HeightField& field, Across across, int first, int last) {
  const bool along_x = across == Across::kX;
  const int length = along_x ? field.width() : field.height();
  std::vector<double> trace(static_cast<std::size_t>(length), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> heights;
  for (int i = 0; i < length; ++i) {
    heights.clear();
    for (int j = first; j <= last; ++j) {
      const double z = along_x ? field.z_um.at(i, j) : field.z_um.at(j, i);
      if (!std::isnan(z)) heights.push_back(z);
    }
    const auto rows = static_cast<std::size_t>(last - first + 1);
    if (2 * heights.size() >= rows && !heights.empty()) trace[static_cast<std::size_t>(i)] = median_of(heights);
  }
  return trace;
}

StepOutcome<GrooveEdges> find_groove_edges(const std::vector<double>& trace, double pitch_um, int lag_points) {
  std::vector<Difference> differences = differences_of(trace, static_cast<std::size_t>(std::max(lag_points, 1)));
  if (differences.size() < kLeastDifferences) return no_edges("it has too few valid points");
  std::vector<double> heights;
  for (const Difference& difference : differences) heights.push_back(difference.height);
  const double slope = median_of(heights);  // of a tilted surface
  for (double& height : heights) height = std::abs(height - slope);
  const double scatter = kMadToDeviation * median_of(heights);
  double highest = 0.0;
  double lowest = 0.0;
  for (Difference& difference : differences) {
    difference.height -= slope;
    highest = std::max(highest, difference.height);
    lowest = std::min(lowest, difference.height);
  }
  if (!(highest > kStandsOut * scatter)) return no_edges("no rise is steeper than its scatter");
  if (!(-lowest > kStandsOut * scatter)) return no_edges("no fall is steeper than its scatter");
  const double rise = flank_centre(differences, 1.0) * pitch_um;
  const double fall = flank_centre(differences, -1.0) * pitch_um;
  return GrooveEdges{std::min(rise, fall), std::max(rise, fall)};
}

}  // namespace fvd::metrology
