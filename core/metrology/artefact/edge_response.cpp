#include "core/metrology/artefact/edge_response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "core/metrology/artefact/two_levels.hpp"

namespace fvd::metrology {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kRounds = 12;
constexpr double kFirstRamp_px = 12.0;
constexpr double kShortest_px = 24.0;  ///< of an edge
constexpr double kPiece_px = 12.0;     ///< along the edge, for its straightness
constexpr double kMostBend = 0.15;     ///< straightness over the ramp's width: beyond it the edge is not straight
constexpr double kMostBend_px = 1.5;   ///< and beyond this
constexpr double kMostWrong = 0.03;    ///< share of the points beside the edge that lie on the other level
constexpr double kSides = 1.0;         ///< in ramp widths from the line: there a side begins
constexpr double kReach = 2.5;         ///< of the profile, in ramp widths to either side
constexpr double kLeastReach_px = 8.0;
constexpr double kShortestPeriod_px = 4.0;
constexpr double kPeriodStep = 1.002;
constexpr int kFewestInBin = 3;
constexpr double kLeastRise = 0.3;  ///< of the step over six pixels: a place on the edge

/// A point beside the edge: across towards the upper level, along it, its share of the step.
struct EdgePoint {
  double across_um = 0.0;
  double along_um = 0.0;
  double share = 0.0;
};

/// across . place = offset; the upper level where it is larger.
struct EdgeLine {
  Eigen::Vector2d across = Eigen::Vector2d::UnitX();
  double offset_um = 0.0;
  double ramp_um = 0.0;  ///< from the foot to the top
};

std::vector<EdgePoint> points_beside(const HeightField& field, const Region& region, const TwoLevels& levels,
                                     const EdgeLine& line) {
  std::vector<EdgePoint> points;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double z = field.z_um.at(x, y);
      if (std::isnan(z) || !is_inside(region, x, y)) continue;
      const Eigen::Vector2d place(field.x_um(x), field.y_um(y));
      points.push_back({line.across.dot(place) - line.offset_um,
                        line.across.x() * place.y() - line.across.y() * place.x(), levels.share(x, y, z)});
    }
  }
  return points;
}

/// The mean slope of the shares points across the edge; half of the transition lies on either side of it.
std::optional<EdgeLine> first_line(const HeightField& field, const Region& region, const TwoLevels& levels) {
  const Plane<float> shares = level_shares(field, region, levels);
  constexpr int kLag = 3;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  int count = 0;
  for (int y = kLag; y < shares.height() - kLag; ++y) {
    for (int x = kLag; x < shares.width() - kLag; ++x) {
      const double dx = static_cast<double>(shares.at(x + kLag, y) - shares.at(x - kLag, y));
      const double dy = static_cast<double>(shares.at(x, y + kLag) - shares.at(x, y - kLag));
      if (!(std::hypot(dx, dy) > kLeastRise)) continue;
      slope += Eigen::Vector2d(dx / field.pitch_x_um, dy / field.pitch_y_um);
      middle += Eigen::Vector2d(field.x_um(x), field.y_um(y));
      ++count;
    }
  }
  if (count == 0 || !(slope.norm() > 0.0)) return std::nullopt;
  EdgeLine line;
  line.across = slope.normalized();
  line.offset_um = line.across.dot(middle) / count;
  line.ramp_um = kFirstRamp_px * std::max(field.pitch_x_um, field.pitch_y_um);
  return line;
}

/// Least squares of the place, the direction and the width of a ramp between the levels, by Gauss-Newton; false where
/// the points do not determine them.
bool improve(EdgeLine& line, const std::vector<EdgePoint>& points, double least_ramp_um) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double along = 0.0;
  int count = 0;
  for (const EdgePoint& point : points) {
    if (std::abs(point.across_um) > 0.5 * line.ramp_um) continue;
    along += point.along_um;
    ++count;
  }
  if (count < kFewestInBin) return false;
  along /= count;
  for (const EdgePoint& point : points) {
    if (std::abs(point.across_um) > 0.5 * line.ramp_um) continue;
    const double out = point.across_um / line.ramp_um;
    const Eigen::Vector3d terms(-1.0 / line.ramp_um, -(point.along_um - along) / line.ramp_um, -out / line.ramp_um);
    matrix += terms * terms.transpose();
    vector += terms * (std::clamp(point.share, -0.5, 1.5) - 0.5 - out);
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-14)) return false;
  const Eigen::Vector3d step = solver.solve(vector);
  const Eigen::Vector2d along_edge(-line.across.y(), line.across.x());
  const double move = std::clamp(step[0], -0.5 * line.ramp_um, 0.5 * line.ramp_um);
  const double turn = std::clamp(step[1], -0.1, 0.1);
  // Turned about the middle of the edge, which keeps its place.
  const Eigen::Vector2d middle = line.across * (line.offset_um + move) + along_edge * along;
  line.across = (line.across - turn * along_edge).normalized();
  line.offset_um = line.across.dot(middle);
  line.ramp_um = std::clamp(line.ramp_um + step[2], 0.5 * line.ramp_um, 2.0 * line.ramp_um);
  line.ramp_um = std::max(line.ramp_um, least_ramp_um);
  return true;
}

/// One plane and a step through the sides without the edge: shares become 0 and 1 on them. The step that was there is
/// returned; absent where the points do not determine it.
std::optional<double> level_sides(std::vector<EdgePoint>& points, const EdgeLine& line) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d vector = Eigen::Vector4d::Zero();
  const double unit = line.ramp_um;
  for (const EdgePoint& point : points) {
    const bool upper = point.across_um > 0.0;
    // Points farther off than half of the step belong to something else.
    const bool foreign = std::abs(point.share - (upper ? 1.0 : 0.0)) > 0.5;
    if (std::abs(point.across_um) < kSides * line.ramp_um || foreign) continue;
    const Eigen::Vector4d terms(1.0, point.across_um / unit, point.along_um / unit, upper ? 1.0 : 0.0);
    matrix += terms * terms.transpose();
    vector += terms * point.share;
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return std::nullopt;
  const Eigen::Vector4d plane = solver.solve(vector);
  if (!(plane[3] > 0.0)) return std::nullopt;
  for (EdgePoint& point : points) {
    point.share -= plane[0] + plane[1] * point.across_um / unit + plane[2] * point.along_um / unit;
    point.share /= plane[3];
  }
  return plane[3];
}

/// Root mean square of the places of pieces of the edge about the line, and its length in whole pieces.
struct Straightness {
  double rms_um = 0.0;
  int pieces = 0;
};
Straightness straightness(const std::vector<EdgePoint>& points, const EdgeLine& line, double piece_um) {
  std::vector<double> sums;
  std::vector<int> counts;
  double first = 1e300;
  for (const EdgePoint& point : points) first = std::min(first, point.along_um);
  for (const EdgePoint& point : points) {
    if (std::abs(point.across_um) > 0.5 * line.ramp_um) continue;
    const auto piece = static_cast<std::size_t>((point.along_um - first) / piece_um);
    if (piece >= sums.size()) {
      sums.resize(piece + 1, 0.0);
      counts.resize(piece + 1, 0);
    }
    sums[piece] += point.across_um - (std::clamp(point.share, -0.5, 1.5) - 0.5) * line.ramp_um;
    ++counts[piece];
  }
  Straightness result;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] < kFewestInBin * 4) continue;
    result.rms_um += std::pow(sums[i] / counts[i], 2);
    ++result.pieces;
  }
  if (result.pieces > 0) result.rms_um = std::sqrt(result.rms_um / result.pieces);
  return result;
}

/// The edge's profile in steps of the levels: means of bins of one width, at the mean places of their points.
struct Profile {
  std::vector<double> across_um;
  std::vector<double> share;
  double bin_um = 0.0;
  double spread_um2 = 0.0;  ///< mean variance of the places within a bin
  int points = 0;
};

std::optional<Profile> profile_of(const std::vector<EdgePoint>& points, double reach_um, double bin_um) {
  // Of an edge along the pixels all points lie at whole pixels from each other: bins are centred on them.
  std::complex<double> beat;
  for (const EdgePoint& point : points) beat += std::polar(1.0, 2.0 * kPi * point.across_um / bin_um);
  const double shift_um = std::arg(beat) / (2.0 * kPi) * bin_um;
  const int half = static_cast<int>(reach_um / bin_um);
  const auto bins = static_cast<std::size_t>(2 * half + 1);
  std::vector<double> across(bins, 0.0);
  std::vector<double> squares(bins, 0.0);
  std::vector<double> shares(bins, 0.0);
  std::vector<int> counts(bins, 0);
  for (const EdgePoint& point : points) {
    const double at = std::round((point.across_um - shift_um) / bin_um) + half;
    if (at < 0.0 || at >= static_cast<double>(bins)) continue;
    const auto bin = static_cast<std::size_t>(at);
    across[bin] += point.across_um;
    squares[bin] += point.across_um * point.across_um;
    shares[bin] += point.share;
    ++counts[bin];
  }
  Profile profile;
  profile.bin_um = bin_um;
  for (std::size_t i = 0; i < bins; ++i) {
    if (counts[i] < kFewestInBin) return std::nullopt;
    profile.across_um.push_back(across[i] / counts[i]);
    profile.share.push_back(shares[i] / counts[i]);
    profile.spread_um2 += std::max(0.0, squares[i] / counts[i] - std::pow(across[i] / counts[i], 2));
    profile.points += counts[i];
  }
  profile.spread_um2 /= static_cast<double>(bins);
  return profile;
}

/// Where the profile passes the share, from its middle outwards.
std::optional<double> place_at(const Profile& profile, double share) {
  std::size_t i = profile.share.size() / 2;
  while (profile.share[i] > share && i > 0) --i;
  while (i + 1 < profile.share.size() && profile.share[i + 1] < share) ++i;
  if (i + 1 >= profile.share.size() || !(profile.share[i] <= share && profile.share[i + 1] >= share))
    return std::nullopt;
  const double part = (share - profile.share[i]) / std::max(profile.share[i + 1] - profile.share[i], 1e-12);
  return profile.across_um[i] + part * (profile.across_um[i + 1] - profile.across_um[i]);
}

double sinc(double x) { return std::abs(x) < 1e-9 ? 1.0 : std::sin(kPi * x) / (kPi * x); }

/// Differences of neighbouring bins stand for the derivative; what the differences and the bins' own width take from
/// the transfer is given back.
double transfer(const Profile& profile, double period_um) {
  std::complex<double> sum;
  for (std::size_t i = 0; i + 1 < profile.share.size(); ++i) {
    const double middle = 0.5 * (profile.across_um[i] + profile.across_um[i + 1]);
    sum += (profile.share[i + 1] - profile.share[i]) * std::polar(1.0, -2.0 * kPi * middle / period_um);
  }
  const double wave = 2.0 * kPi / period_um;
  const double taken = sinc(profile.bin_um / period_um) * std::exp(-0.5 * wave * wave * profile.spread_um2);
  return std::abs(sum) / (std::abs(profile.share.back() - profile.share.front()) * taken);
}

std::optional<double> half_period(const Profile& profile, double pitch_um) {
  double before = 1.0;
  const double longest = 4.0 * (profile.across_um.back() - profile.across_um.front());
  for (double period = longest; period > kShortestPeriod_px * pitch_um; period /= kPeriodStep) {
    const double here = transfer(profile, period);
    if (here <= 0.5) return period * (1.0 + (kPeriodStep - 1.0) * (0.5 - here) / std::max(before - here, 1e-12));
    before = here;
  }
  return std::nullopt;
}

double positive_deg(double angle) {
  const double degrees = std::fmod(angle * 180.0 / kPi + 360.0, 180.0);
  return degrees > 180.0 - 1e-9 ? 0.0 : degrees;
}

}  // namespace

StudyOutcome<EdgeResponse> edge_response(const HeightField& field, const Region& region) {
  const StudyOutcome<TwoLevels> levels_or = two_levels(field, region);
  if (const auto* refusal = std::get_if<StudyRefusal>(&levels_or)) return *refusal;
  const TwoLevels& levels = std::get<TwoLevels>(levels_or);
  const StudyRefusal not_straight{"the two levels do not meet in one straight edge"};
  const double pitch_um = std::max(field.pitch_x_um, field.pitch_y_um);
  std::optional<EdgeLine> line = first_line(field, region, levels);
  if (!line) return not_straight;
  std::vector<EdgePoint> points;
  for (int round = 0; round < kRounds; ++round) {
    points = points_beside(field, region, levels, *line);
    if (!improve(*line, points, 2.0 * pitch_um)) return not_straight;
  }
  points = points_beside(field, region, levels, *line);
  const Straightness bend = straightness(points, *line, kPiece_px * pitch_um);
  if (bend.pieces * kPiece_px < kShortest_px) return StudyRefusal{"the edge is shorter than 24 pixels"};
  if (bend.rms_um > std::max(kMostBend * line->ramp_um, kMostBend_px * pitch_um)) return not_straight;
  const auto wrong = [&](const EdgePoint& point) {
    return std::abs(point.across_um) > line->ramp_um && (point.share > 0.5) != (point.across_um > 0.0);
  };
  const auto wrong_points = static_cast<double>(std::count_if(points.begin(), points.end(), wrong));
  if (wrong_points > kMostWrong * static_cast<double>(points.size())) return not_straight;

  const std::optional<double> step = level_sides(points, *line);
  if (!step) return StudyRefusal{"too few points are valid beside the edge"};
  const double reach_um = std::max(kReach * line->ramp_um, kLeastReach_px * pitch_um);
  std::optional<Profile> profile;
  for (const double bin_px : {0.25, 0.5, 1.0}) {
    profile = profile_of(points, reach_um, bin_px * pitch_um);
    if (profile) break;
  }
  if (!profile) return StudyRefusal{"too few points are valid beside the edge"};

  EdgeResponse response;
  response.across_deg = positive_deg(std::atan2(line->across.y(), line->across.x()));
  response.edge_deg = std::fmod(response.across_deg + 90.0, 180.0);
  response.height_um = *step * levels.step_um;
  response.points = profile->points;
  response.straightness_px = bend.rms_um / pitch_um;
  const std::optional<double> low = place_at(*profile, 0.1);
  const std::optional<double> high = place_at(*profile, 0.9);
  if (!low || !high) return StudyRefusal{"the edge's profile does not rise from one level to the other"};
  response.width_10_90_um = *high - *low;
  response.period_um = half_period(*profile, pitch_um);
  if (!response.period_um) response.reason = "resolved down to a period of four pixels";
  return response;
}

}  // namespace fvd::metrology
