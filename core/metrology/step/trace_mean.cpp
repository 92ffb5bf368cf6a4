#include "core/metrology/step/trace_mean.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fvd::metrology {

StepTraces list_of(const std::vector<MeasuredTrace>& traces, int left_out) {
  StepTraces list;
  list.left_out = left_out;
  for (const MeasuredTrace& one : traces) {
    list.each.push_back(one.trace);
    list.mean_um += one.trace.height_um / static_cast<double>(traces.size());
  }
  double squares = 0.0;
  for (const StepTrace& one : list.each) squares += (one.height_um - list.mean_um) * (one.height_um - list.mean_um);
  if (traces.size() > 1) list.sd_um = std::sqrt(squares / static_cast<double>(traces.size() - 1));
  return list;
}

StepValue mean_of(const HeightField& field, const std::vector<MeasuredTrace>& traces) {
  const auto count = static_cast<double>(traces.size());
  StepValue mean;
  WeightMap& map = mean.weights;
  map.left = traces.front().value.weights.left;
  map.top = traces.front().value.weights.top;
  int right = map.left;
  int bottom = map.top;
  for (const MeasuredTrace& one : traces) {
    const WeightMap& weights = one.value.weights;
    map.left = std::min(map.left, weights.left);
    map.top = std::min(map.top, weights.top);
    right = std::max(right, weights.left + weights.weights.width());
    bottom = std::max(bottom, weights.top + weights.weights.height());
    mean.height_um += one.value.height_um / count;
    mean.vertical_um += one.value.vertical_um / count;
    mean.slope_x += one.value.slope_x / count;
    mean.slope_y += one.value.slope_y / count;
    mean.points += one.value.points;
  }
  map.weights = Plane<double>(right - map.left, bottom - map.top, 0.0);
  for (const MeasuredTrace& one : traces) {
    const WeightMap& weights = one.value.weights;
    for (int y = 0; y < weights.weights.height(); ++y) {
      for (int x = 0; x < weights.weights.width(); ++x) {
        map.weights.at(weights.left + x - map.left, weights.top + y - map.top) += weights.weights.at(x, y) / count;
      }
    }
  }
  if (field.has_sigma()) mean.noise = linear_noise(field, map);
  return mean;
}

void turn_back(StepValue& value) {
  std::swap(value.slope_x, value.slope_y);
  WeightMap turned;
  turned.left = value.weights.top;
  turned.top = value.weights.left;
  const Plane<double>& weights = value.weights.weights;
  turned.weights = Plane<double>(weights.height(), weights.width(), 0.0);
  for (int y = 0; y < weights.height(); ++y) {
    for (int x = 0; x < weights.width(); ++x) turned.weights.at(y, x) = weights.at(x, y);
  }
  value.weights = std::move(turned);
}

}  // namespace fvd::metrology
