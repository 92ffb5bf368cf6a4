#include "daemon/views/measured_points.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "daemon/evaluation/evaluation_plan.hpp"
#include "daemon/evaluation/surface_chain.hpp"

namespace fvd {

namespace {

constexpr int kTile = 128;  // points a side

int tiles_of(int points) { return (points + kTile - 1) / kTile; }

Plane<float> window_of(const MapRows& map, int x, int y, int width, int height) {
  Plane<float> window = Plane<float>::unset(width, height);
  for (int row = 0; row < height; ++row) map.read(x, y + row, width, window.row(row));
  return window;
}

}  // namespace

MeasuredPoints::MeasuredPoints(std::shared_ptr<const MapRows> heights, std::shared_ptr<const MapRows> sigmas,
                               const std::optional<Calibration>& calibration)
    : heights_(std::move(heights)), sigmas_(std::move(sigmas)) {
  context_.calibration = calibration;
  const GridSize size = heights_->size();
  tiles_across_ = tiles_of(size.width);
  // A slanting line touches at most as many as both sides have, and as many again beside them.
  most_tiles_ = 4 * static_cast<std::size_t>(tiles_across_ + tiles_of(size.height));
}

double MeasuredPoints::height_um(int column, int row) {
  const Place at = place(column, row);
  return at.tile.z_um.at(at.column, at.row);
}

double MeasuredPoints::sigma_um(int column, int row) {
  const Place at = place(column, row);
  if (!at.tile.has_sigma()) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(at.tile.sigma_um.at(at.column, at.row));
}

MeasuredPoints::Place MeasuredPoints::place(int column, int row) {
  const int index = row / kTile * tiles_across_ + column / kTile;
  if (index != last_index_) {
    last_ = &tile(index);
    last_index_ = index;
  }
  return {*last_, column % kTile, row % kTile};
}

const metrology::HeightField& MeasuredPoints::tile(int index) {
  if (const auto known = tiles_.find(index); known != tiles_.end()) return known->second;
  metrology::HeightField field = made(index);
  if (tiles_.size() == most_tiles_) {
    tiles_.erase(oldest_first_.front());
    oldest_first_.pop_front();
  }
  oldest_first_.push_back(index);
  return tiles_.emplace(index, std::move(field)).first->second;
}

metrology::HeightField MeasuredPoints::made(int index) const {
  const GridSize size = heights_->size();
  const int x = index % tiles_across_ * kTile;
  const int y = index / tiles_across_ * kTile;
  const int width = std::min(kTile, size.width - x);
  const int height = std::min(kTile, size.height - y);
  Surface surface;
  surface.height_m = window_of(*heights_, x, y, width, height);
  if (sigmas_) surface.sigma_m = window_of(*sigmas_, x, y, width, height);
  surface.pitch_x_um = 1.0;  // where the points lie is known to who asks for them
  surface.pitch_y_um = 1.0;
  const EvaluationPlan nothing_done;
  return SurfaceChain(surface, nothing_done, context_, nullptr).state(kMeasuredSurface).field.clone();
}

}  // namespace fvd
