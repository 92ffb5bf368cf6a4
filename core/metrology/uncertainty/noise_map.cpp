#include "core/metrology/uncertainty/noise_map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/uncertainty/random_normal.hpp"

namespace fvd::metrology {

NoiseMaps::NoiseMaps(const HeightField& field, std::uint64_t seed)
    : field_(field),
      seed_(seed),
      white_(field.width() + 2 * field.kernel.reach_px(), field.height() + 2 * field.kernel.reach_px()),
      columns_(field.width(), field.height() + 2 * field.kernel.reach_px()) {
  if (!field.has_sigma()) throw Error(ErrorCode::kBadInput, "noise cannot be drawn for heights without sigma");
}

void NoiseMaps::add_to_heights(std::uint64_t draw, Plane<double>& z_um) {
  assert(z_um.width() == field_.width() && z_um.height() == field_.height());
  RandomNormal random(seed_, draw);
  for (double& value : white_.pixels()) value = random.normal();

  const std::vector<double>& kernel = field_.kernel.weights;
  const auto width = static_cast<std::size_t>(field_.width());
  for (int y = 0; y < columns_.height(); ++y) {
    double* averaged = columns_.row(y);
    const double* white = white_.row(y);
    std::fill_n(averaged, width, 0.0);
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      for (std::size_t x = 0; x < width; ++x) averaged[x] += kernel[tap] * white[x + tap];
    }
  }
  // Scaled to unit variance: the kernel's squares sum to 1 / width_px^2 in two dimensions.
  const double scale = field_.kernel.width_px();
  std::vector<double> averaged(width);
  for (int y = 0; y < field_.height(); ++y) {
    std::fill(averaged.begin(), averaged.end(), 0.0);
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const double* source = columns_.row(y + static_cast<int>(tap));
      for (std::size_t x = 0; x < width; ++x) averaged[x] += kernel[tap] * source[x];
    }
    const double* truth = field_.z_um.row(y);
    const float* sigma = field_.sigma_um.row(y);
    double* z = z_um.row(y);
    for (std::size_t x = 0; x < width; ++x) {
      z[x] = std::isnan(truth[x]) ? truth[x] : truth[x] + static_cast<double>(sigma[x]) * scale * averaged[x];
    }
  }
}

}  // namespace fvd::metrology
