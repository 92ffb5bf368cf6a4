#include "core/metrology/artefact/line_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

constexpr int kBins = 240;              ///< of a pitch
constexpr double kLeastContrast = 0.3;  ///< of a line against the cells, in the mean
constexpr double kNarrowestEdge_px = 2.0;
constexpr double kShortestArm_px = 3.0;
constexpr double kFewestOfPlaces = 0.5;  ///< of an edge's places that must lie in the image
constexpr double kFewestValid = 0.25;    ///< of them that must be valid
constexpr int kFewestPoints = 6;
constexpr double kLargestTurn = 0.1;
constexpr double kLargestRest = 0.25;  ///< root mean square of the residuals, of the line's height
constexpr int kRounds = 12;

/// First crossing of the level from the top outwards, in bins from the middle; direction -1 or 1.
std::optional<double> width_at(const std::vector<double>& profile, double level, int direction) {
  double before = profile[kBins / 2];
  for (int k = 1; k <= kBins / 2 - 1; ++k) {
    const double here = profile[static_cast<std::size_t>(kBins / 2 + direction * k)];
    if (here <= level && before > level) return k - 1 + (before - level) / (before - here);
    before = here;
  }
  return std::nullopt;
}

/// A place near a crossing, along and across a line.
struct Sample {
  double across = 0.0;
  double along = 0.0;
  double share = 0.0;  ///< 0 beside the line, 1 on it; NaN in a hole
};

struct Line {
  double left = 0.0;  ///< places of the edges beside the crossing
  double right = 0.0;
  double turn = 0.0;  ///< across per along
  [[nodiscard]] double middle() const { return 0.5 * (left + right); }
};

/// What an edge's ramp says at a sample: its own share, and the sample's distance from the half-way place.
struct Ramp {
  bool right = false;
  double out = 0.0;  ///< outwards, in edge widths
  double share = 0.0;
};

Ramp ramp_at(const Line& line, const Sample& sample, double edge_px) {
  const double from_turned = sample.across - line.turn * sample.along;
  Ramp ramp;
  ramp.right = from_turned > line.middle();
  ramp.out = (ramp.right ? from_turned - line.right : line.left - from_turned) / edge_px;
  ramp.share = std::clamp(0.5 - ramp.out, 0.0, 1.0);
  return ramp;
}

/// One Gauss-Newton step; false where the points do not determine it.
bool improve(Line& line, const std::vector<Sample>& samples, double edge_px) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (const Sample& sample : samples) {
    if (std::isnan(sample.share)) continue;
    const Ramp ramp = ramp_at(line, sample, edge_px);
    if (std::abs(ramp.out) > 0.5) continue;
    // The share falls by 1 over the edge: a right edge that moves outwards lifts it, a left edge likewise.
    const double by_edge = (ramp.right ? 1.0 : -1.0) / edge_px;
    const Eigen::Vector3d terms(ramp.right ? 0.0 : by_edge, ramp.right ? by_edge : 0.0, by_edge * sample.along);
    matrix += terms * terms.transpose();
    vector += terms * (sample.share - ramp.share);
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-9)) return false;
  const Eigen::Vector3d step = solver.solve(vector);
  const double longest = 0.5 * edge_px;
  line.left += std::clamp(step[0], -longest, longest);
  line.right += std::clamp(step[1], -longest, longest);
  line.turn = std::clamp(line.turn + step[2], -2.0 * kLargestTurn, 2.0 * kLargestTurn);
  return true;
}

/// Places and valid points in the ramps: left and right edge, before and after the crossing.
struct Seen {
  std::array<int, 4> places{};
  std::array<int, 4> valid{};
  double squares = 0.0;
};

Seen seen(const Line& line, const std::vector<Sample>& samples, double edge_px) {
  Seen result;
  for (const Sample& sample : samples) {
    const Ramp ramp = ramp_at(line, sample, edge_px);
    if (std::abs(ramp.out) > 0.5) continue;
    const std::size_t part = (ramp.right ? 1U : 0U) + (sample.along > 0.0 ? 2U : 0U);
    ++result.places[part];
    if (std::isnan(sample.share)) continue;
    ++result.valid[part];
    result.squares += (sample.share - ramp.share) * (sample.share - ramp.share);
  }
  return result;
}

struct LineFit {
  bool expected = false;
  std::optional<Line> line;
};

LineFit fit_line(const std::vector<Sample>& samples, const LineShape& shape, double arm_px, double spacing_px) {
  const Line start{-0.5 * shape.width_px, 0.5 * shape.width_px, 0.0};
  const double places = shape.edge_px * arm_px;
  LineFit fit;
  const Seen before = seen(start, samples, shape.edge_px);
  fit.expected = *std::min_element(before.places.begin(), before.places.end()) >= kFewestOfPlaces * places;
  if (!fit.expected) return fit;
  Line line = start;
  // Wide ramps first: they draw from afar.
  const double gap = spacing_px - shape.width_px;
  const double wide = std::max(shape.edge_px, 0.8 * std::min(shape.width_px, gap));
  for (int round = 0; round < kRounds; ++round) {
    if (!improve(line, samples, round < 4 ? wide : shape.edge_px)) return fit;
  }
  const Seen after = seen(line, samples, shape.edge_px);
  const int fewest = *std::min_element(after.valid.begin(), after.valid.end());
  int all = 0;
  for (const int valid : after.valid) all += valid;
  const bool plausible = std::abs(line.middle()) < 0.25 * spacing_px && std::abs(line.turn) < kLargestTurn &&
                         std::abs(line.right - line.left - shape.width_px) < 0.5 * shape.width_px;
  if (!plausible || fewest < kFewestPoints || fewest < kFewestValid * places) return fit;
  if (std::sqrt(after.squares / all) > kLargestRest) return fit;
  fit.line = line;
  return fit;
}

/// From the other family's edge to half of the way to the next crossing.
struct Arm {
  double from_px = 0.0;
  double to_px = 0.0;
};
Arm arm_beside(const LineShape& other, double spacing_px) {
  return {0.5 * (other.width_px + other.edge_px) + 1.0, 0.5 * spacing_px};
}

/// Where left and right line meet: both run through their middles at the crossing expected.
Eigen::Vector2d meeting(const GridLattice& lattice, const Line& x_line, const Line& y_line) {
  // Points of a line: across . place - turn * (along . place) = middle.
  Eigen::Matrix2d matrix;
  matrix.row(0) = (lattice.across(0) - x_line.turn * lattice.along(0)).transpose();
  matrix.row(1) = (lattice.across(1) - y_line.turn * lattice.along(1)).transpose();
  return matrix.inverse() * Eigen::Vector2d(x_line.middle(), y_line.middle());
}

}  // namespace

std::optional<LineShape> line_shape(const Plane<float>& shares, const GridLattice& lattice, int family) {
  std::vector<double> sums(kBins + 1, 0.0);
  std::vector<double> counts(kBins + 1, 0.0);
  for (int y = 0; y < shares.height(); ++y) {
    for (int x = 0; x < shares.width(); ++x) {
      const double share = static_cast<double>(shares.at(x, y));
      if (std::isnan(share)) continue;
      const Eigen::Vector2d index = lattice.index({1.0 * x, 1.0 * y});
      const double beside = index[1 - family] - std::round(index[1 - family]);
      if (std::abs(beside) < 0.35) continue;
      const double off = index[family] - std::round(index[family]);
      const auto bin = static_cast<std::size_t>(std::lround((off + 0.5) * kBins));
      sums[bin] += share;
      counts[bin] += 1.0;
    }
  }
  // A bin that no pixel's centre falls into, as of a grid along the pixels, takes its neighbour's mean.
  const auto filled = std::find_if(counts.begin(), counts.end(), [](double count) { return count > 0.0; });
  if (filled == counts.end()) return std::nullopt;
  const auto first = static_cast<std::size_t>(filled - counts.begin());
  double last = sums[first] / counts[first];
  for (std::size_t i = 0; i <= kBins; ++i) {
    if (counts[i] > 0.0) last = sums[i] / counts[i];
    sums[i] = last;
  }
  LineShape shape{0.0, 0.0, 0.0, 0.0};
  const double bin_px = lattice.spacing_px(family) / kBins;
  for (int k = -6; k <= 6; ++k) {
    shape.top += sums[static_cast<std::size_t>(kBins / 2 + k)] / 13.0;
    shape.foot += 0.5 * (sums[static_cast<std::size_t>(6 + k)] + sums[static_cast<std::size_t>(kBins - 6 + k)]) / 13.0;
  }
  const double rise = shape.top - shape.foot;
  if (rise < kLeastContrast) return std::nullopt;
  for (const int direction : {-1, 1}) {
    const auto half = width_at(sums, shape.foot + 0.5 * rise, direction);
    const auto low = width_at(sums, shape.foot + 0.25 * rise, direction);
    const auto high = width_at(sums, shape.foot + 0.75 * rise, direction);
    if (!half || !low || !high) return std::nullopt;
    shape.width_px += *half * bin_px;
    shape.edge_px += (*low - *high) * bin_px;  // half of the edge, on two sides
  }
  const double gap = lattice.spacing_px(family) - shape.width_px;
  shape.edge_px =
      std::clamp(shape.edge_px, kNarrowestEdge_px, std::max(kNarrowestEdge_px, std::min(shape.width_px, gap)));
  return shape;
}

CrossingFit fit_crossing(const Plane<float>& shares, const GridLattice& lattice, const LineShape& shape_x,
                         const LineShape& shape_y, int i, int j) {
  const std::array<const LineShape*, 2> shapes{&shape_x, &shape_y};
  const Eigen::Vector2d centre = lattice.place(i, j);
  std::array<Arm, 2> arms{};
  for (std::size_t family = 0; family < 2; ++family) {
    const int other = family == 0 ? 1 : 0;
    arms[family] = arm_beside(*shapes[1 - family], lattice.spacing_px(other));
    if (arms[family].to_px - arms[family].from_px < kShortestArm_px) return {};
  }
  const Eigen::Vector2d reach = 0.5 * (lattice.step_x.cwiseAbs() + lattice.step_y.cwiseAbs());
  const int first_x = std::max(0, static_cast<int>(std::floor(centre.x() - reach.x())));
  const int last_x = std::min(shares.width() - 1, static_cast<int>(std::ceil(centre.x() + reach.x())));
  const int first_y = std::max(0, static_cast<int>(std::floor(centre.y() - reach.y())));
  const int last_y = std::min(shares.height() - 1, static_cast<int>(std::ceil(centre.y() + reach.y())));
  std::array<std::vector<Sample>, 2> samples;
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const Eigen::Vector2d from = Eigen::Vector2d(x, y) - centre;
      const std::array<double, 2> across{from.dot(lattice.across(0)), from.dot(lattice.across(1))};
      for (std::size_t family = 0; family < 2; ++family) {
        const int own = static_cast<int>(family);
        const double beside = std::abs(across[1 - family]);
        if (beside < arms[family].from_px || beside > arms[family].to_px) continue;
        if (std::abs(across[family]) > 0.5 * lattice.spacing_px(own)) continue;
        const double share = static_cast<double>(shares.at(x, y));
        const double foot = shapes[family]->foot;
        samples[family].push_back(
            {across[family], from.dot(lattice.along(own)), (share - foot) / (shapes[family]->top - foot)});
      }
    }
  }
  const LineFit x_fit = fit_line(samples[0], shape_x, arms[0].to_px - arms[0].from_px, lattice.spacing_px(0));
  const LineFit y_fit = fit_line(samples[1], shape_y, arms[1].to_px - arms[1].from_px, lattice.spacing_px(1));
  CrossingFit fit;
  fit.expected = x_fit.expected && y_fit.expected;
  if (fit.expected && x_fit.line && y_fit.line) fit.place = centre + meeting(lattice, *x_fit.line, *y_fit.line);
  return fit;
}

}  // namespace fvd::metrology
