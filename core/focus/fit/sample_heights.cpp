#include "core/focus/fit/sample_heights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/focus/fit/height_map.hpp"

namespace fvd {

SampleHeights::SampleHeights(int bin_slices, int max_slices) : bin_slices_(bin_slices) {
  sums_um_.reserve(static_cast<std::size_t>((max_slices + bin_slices - 1) / bin_slices));
}

void SampleHeights::push(double z_um) {
  if (pending() == 0) sums_um_.push_back(0.0);
  sums_um_.back() += z_um;
  ++slices_;
}

std::vector<double> SampleHeights::means_um() const {
  std::vector<double> means = sums_um_;
  for (double& mean : means) mean /= bin_slices_;
  if (pending() > 0) means.back() *= static_cast<double>(bin_slices_) / pending();
  return means;
}

std::vector<HeightEntry> height_table(const std::vector<double>& z_um) {
  const auto count = z_um.size();
  std::vector<HeightEntry> table(count);
  for (std::size_t i = 0; i < count; ++i) {
    HeightEntry& entry = table[i];
    entry.z_um = static_cast<float>(z_um[i]);
    if (i == 0) entry.mask |= mask_reason::kFirstSlice;
    if (i + 1 == count) entry.mask |= mask_reason::kLastSlice;
    if (entry.mask != 0) continue;
    const double left = z_um[i - 1] - z_um[i];
    const double right = z_um[i + 1] - z_um[i];
    if (!(left * right < 0.0)) {
      entry.mask |= mask_reason::kNotBracketed;  // the heights do not run one way
      continue;
    }
    const double scale = (std::abs(left) + std::abs(right)) / 2;
    entry.scale_um = static_cast<float>(scale);
    entry.u_left = static_cast<float>(left / scale);
    entry.u_right = static_cast<float>(right / scale);
    if (i >= 2 && (z_um[i - 2] - z_um[i - 1]) * left > 0.0) {
      entry.u_left2 = static_cast<float>((z_um[i - 2] - z_um[i]) / scale);
    }
    if (i + 2 < count && (z_um[i + 2] - z_um[i + 1]) * right > 0.0) {
      entry.u_right2 = static_cast<float>((z_um[i + 2] - z_um[i]) / scale);
    }
  }
  return table;
}

double median_step_um(const std::vector<double>& z_um) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < z_um.size(); ++k) steps.push_back(std::abs(z_um[k] - z_um[k - 1]));
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace fvd
