#include "core/focus/judge/slice_drift.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

namespace fvd {

namespace {

/// A patch whose shift is farther from the median of all moved by itself, or was mistaken.
constexpr double kMaxFromMedian_px = 1.0;

struct PlacedShift {
  double place_x;
  double place_y;
  PatchShift shift;
};

double median_of(const std::vector<PlacedShift>& shifts, double PatchShift::*of) {
  std::vector<double> values;
  for (const PlacedShift& placed : shifts) values.push_back(placed.shift.*of);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void drop_strays(std::vector<PlacedShift>& shifts) {
  if (shifts.size() < 3) return;
  const double x_px = median_of(shifts, &PatchShift::x_px);
  const double y_px = median_of(shifts, &PatchShift::y_px);
  shifts.erase(std::remove_if(shifts.begin(), shifts.end(),
                              [&](const PlacedShift& placed) {
                                return std::abs(placed.shift.x_px - x_px) > kMaxFromMedian_px ||
                                       std::abs(placed.shift.y_px - y_px) > kMaxFromMedian_px;
                              }),
               shifts.end());
}

/// What patches have in common: shift = (x, y) + scale * place.
struct Motion {
  bool known = false;
  double x_px = 0.0;
  double y_px = 0.0;
  std::optional<double> scale = {};
};

/// Places are divided by this, so that the three unknowns are of one size.
constexpr double kPlace_px = 100.0;

/// Weighted least squares. The scale is left at 1 where patches are few or lie together.
Motion common_motion(const std::vector<PlacedShift>& shifts) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& [place_x, place_y, shift] : shifts) {
    Eigen::Matrix<double, 2, 3> design;
    design << 1.0, 0.0, place_x / kPlace_px, 0.0, 1.0, place_y / kPlace_px;
    Eigen::Matrix2d weight;
    weight << shift.weight_xx, shift.weight_xy, shift.weight_xy, shift.weight_yy;
    normal += design.transpose() * weight * design;
    right += design.transpose() * weight * Eigen::Vector2d(shift.x_px, shift.y_px);
  }
  Motion motion;
  if (shifts.size() > 1) {
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    if (solver.rcond() > 1e-6) {
      const Eigen::Vector3d found = solver.solve(right);
      return {true, found[0], found[1], found[2] / kPlace_px};
    }
  }
  const Eigen::Vector2d found = normal.topLeftCorner<2, 2>().ldlt().solve(right.head<2>());
  if (found.allFinite()) motion = {true, found[0], found[1], {}};
  return motion;
}

/// A rate per um from single steps: the mean over z, and its standard error from what the steps differ by.
struct Rate {
  double mean = 0.0;
  double error = 0.0;
  int steps = 0;
};
struct RateSums {
  double rise_um = 0.0;
  double move = 0.0;
  std::vector<std::pair<double, double>> steps;

  void add(double by_um, double moved) {
    rise_um += by_um;
    move += moved;
    steps.emplace_back(by_um, moved);
  }
  [[nodiscard]] Rate rate() const {
    Rate rate;
    rate.steps = static_cast<int>(steps.size());
    if (rate.steps == 0 || rise_um == 0.0) return rate;
    rate.mean = move / rise_um;
    double squares = 0.0;
    for (const auto& [by_um, moved] : steps) squares += std::pow(moved - rate.mean * by_um, 2);
    if (rate.steps > 1) rate.error = std::sqrt(squares * rate.steps / (rate.steps - 1)) / std::abs(rise_um);
    return rate;
  }
};

}  // namespace

DriftPath::DriftPath(double x_px_per_um, double y_px_per_um, double middle_um)
    : line_(Place{middle_um, x_px_per_um, y_px_per_um}) {}

void DriftPath::centre(std::size_t index) {
  const Place middle = places_[index];
  for (Place& place : places_) {
    place.x_px -= middle.x_px;
    place.y_px -= middle.y_px;
  }
}

DriftPath::Place DriftPath::at(double z_um) const noexcept {
  if (line_) return {z_um, line_->x_px * (z_um - line_->z_um), line_->y_px * (z_um - line_->z_um)};
  if (places_.empty()) return {z_um, 0.0, 0.0};
  return *std::min_element(places_.begin(), places_.end(), [z_um](const Place& a, const Place& b) {
    return std::abs(a.z_um - z_um) < std::abs(b.z_um - z_um);
  });
}

void DriftMeter::add(SlicePatches patches, double z_um) {
  if (!z_um_.empty()) {
    const Step step = compare(patches, z_um - z_um_.back());
    if (step.known) {
      guess_x_ = static_cast<int>(std::lround(step.x_px));
      guess_y_ = static_cast<int>(std::lround(step.y_px));
    }
    steps_.push_back(step);
  }
  z_um_.push_back(z_um);
  last_ = std::move(patches);
}

DriftMeter::Step DriftMeter::compare(const SlicePatches& patches, double rise_um) const {
  Step step{.rise_um = rise_um};
  std::vector<PlacedShift> shifts;
  for (std::size_t i = 0; i < std::min(patches.values.size(), last_.values.size()); ++i) {
    const auto shift = patch_shift(last_.values[i], patches.values[i], patches.side, guess_x_, guess_y_);
    if (shift) shifts.push_back({patches.x_px[i], patches.y_px[i], *shift});
  }
  drop_strays(shifts);
  if (shifts.empty()) return step;
  const Motion motion = common_motion(shifts);
  step.known = motion.known;
  step.x_px = motion.x_px;
  step.y_px = motion.y_px;
  step.scale = motion.scale;
  return step;
}

std::optional<DriftFigures> DriftMeter::figures() const {
  RateSums x;
  RateSums y;
  RateSums scale;
  double whole_um = 0.0;
  for (const Step& step : steps_) {
    whole_um += step.rise_um;
    if (!step.known) continue;
    x.add(step.rise_um, step.x_px);
    y.add(step.rise_um, step.y_px);
    if (step.scale) scale.add(step.rise_um, *step.scale);
  }
  if (x.steps.empty() || x.rise_um == 0.0) return std::nullopt;
  const Rate right = x.rate();
  const Rate down = y.rate();
  DriftFigures figures;
  figures.x_px_per_um = right.mean;
  figures.y_px_per_um = down.mean;
  figures.error_px_per_um = std::max(right.error, down.error);
  figures.x_px = x.move + right.mean * (whole_um - x.rise_um);
  figures.y_px = y.move + down.mean * (whole_um - y.rise_um);
  if (!scale.steps.empty() && scale.rise_um != 0.0) {
    const Rate growth = scale.rate();
    figures.scale_per_um = growth.mean;
    figures.scale_error_per_um = growth.error;
  }
  return figures;
}

DriftPath DriftMeter::path() const {
  DriftPath path;
  const auto known = figures();
  if (!known) return path;
  double x_px = 0.0;
  double y_px = 0.0;
  path.add(z_um_.front(), 0.0, 0.0);
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const Step& step = steps_[k];
    x_px += step.known ? step.x_px : known->x_px_per_um * step.rise_um;
    y_px += step.known ? step.y_px : known->y_px_per_um * step.rise_um;
    path.add(z_um_[k + 1], x_px, y_px);
  }
  path.centre(path.places() / 2);
  return path;
}

}  // namespace fvd
