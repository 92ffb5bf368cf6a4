#include "core/focus/sample_heights.hpp"

#include <cmath>
#include <utility>

#include "core/focus/height_map.hpp"

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

HeightTables::HeightTables(std::vector<double> z_um) : z_um_(std::move(z_um)) {
  const auto count = z_um_.size();
  scale_um_.assign(count, 1.0F);
  for (auto* table : {&u_left2_, &u_left_, &u_right_, &u_right2_}) table->assign(count, 0.0F);
  mask_.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0) mask_[i] |= mask_reason::kFirstSlice;
    if (i + 1 == count) mask_[i] |= mask_reason::kLastSlice;
    if (mask_[i] != 0) continue;
    const double left = z_um_[i - 1] - z_um_[i];
    const double right = z_um_[i + 1] - z_um_[i];
    if (!(left * right < 0.0)) {
      mask_[i] |= mask_reason::kNotBracketed;  // the heights do not run one way
      continue;
    }
    const double scale = (std::abs(left) + std::abs(right)) / 2;
    scale_um_[i] = static_cast<float>(scale);
    u_left_[i] = static_cast<float>(left / scale);
    u_right_[i] = static_cast<float>(right / scale);
    if (i >= 2 && (z_um_[i - 2] - z_um_[i - 1]) * left > 0.0) {
      u_left2_[i] = static_cast<float>((z_um_[i - 2] - z_um_[i]) / scale);
    }
    if (i + 2 < count && (z_um_[i + 2] - z_um_[i + 1]) * right > 0.0) {
      u_right2_[i] = static_cast<float>((z_um_[i + 2] - z_um_[i]) / scale);
    }
  }
}

HeightTable HeightTables::view() const noexcept {
  return {z_um_.data(),    scale_um_.data(), u_left2_.data(), u_left_.data(),
          u_right_.data(), u_right2_.data(), mask_.data()};
}

}  // namespace fvd
