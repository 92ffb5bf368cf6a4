#include "sim/world/layered_renderer.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

#include "sim/world/texture.hpp"

namespace fvd::sim {

namespace {

/// Larger blurs are rendered as this one: hardly any texture is left.
constexpr double kLargestBlur_px = 24.0;
constexpr int kMargin_px = 72;
/// The far plane's texture is another one than the near plane's.
constexpr std::uint64_t kFarSeed = 9973;

/// A texture of that mean and standard deviation, grey levels.
Plane<float> texture_of(const WorldParameters& world, const Layer& layer, int width, int height, std::uint64_t seed) {
  const Plane<std::uint8_t> rich(width, height);
  Plane<float> texture = make_texture(world.texture, rich, layer.contrast, 1.0, seed);
  for (float& level : texture.pixels()) level += static_cast<float>(layer.grey) - 128.0F;
  return texture;
}

}  // namespace

double near_coverage(const WorldParameters& world, int x, int y) {
  if (world.edge_radius_px <= 0.0) return x < world.width_px / 2 ? 1.0 : 0.0;
  const double distance = std::hypot(x - 0.5 * (world.width_px - 1), y - 0.5 * (world.height_px - 1));
  return std::clamp(world.edge_radius_px - distance + 0.5, 0.0, 1.0);
}

/// The planes beyond the sensor's borders too.
struct LayeredRenderer::Canvas {
  Plane<float> near;
  Plane<float> coverage;
  Plane<float> far;

  explicit Canvas(const WorldParameters& world) {
    const int width = cv::getOptimalDFTSize(world.width_px + 2 * kMargin_px);
    const int height = cv::getOptimalDFTSize(world.height_px + 2 * kMargin_px);
    near = texture_of(world, world.near, width, height, world.seed);
    far = texture_of(world, world.far, width, height, world.seed + kFarSeed);
    coverage = Plane<float>(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        coverage.at(x, y) = static_cast<float>(near_coverage(world, x - kMargin_px, y - kMargin_px));
        near.at(x, y) *= coverage.at(x, y);
      }
    }
  }
};

LayeredRenderer::LayeredRenderer(const WorldParameters& world, int threads)
    : LayeredRenderer(world, Canvas(world), threads) {}

LayeredRenderer::LayeredRenderer(const WorldParameters& world, const Canvas& canvas, int threads)
    : world_(world),
      canvas_pixels_(canvas.far.pixels().size()),
      near_(canvas.near),
      coverage_(canvas.coverage),
      far_(canvas.far),
      sensor_(world.width_px, {.readout_noise = world.readout_noise, .seed = world.seed, .threads = threads}) {}

std::size_t LayeredRenderer::memory_bytes() const {
  constexpr std::size_t kSpectra = 3;
  return kSpectra * 2 * canvas_pixels_ * sizeof(float) + sensor_.memory_bytes();
}

double LayeredRenderer::blur_px2(double defocus_um) const {
  const double sigma_px = std::min(world_.defocus_px_per_um * std::abs(defocus_um), kLargestBlur_px);
  return sigma_px * sigma_px;
}

void LayeredRenderer::render(double z_um, const ExposureRequest& request, std::span<std::byte> out) {
  const double near_px2 = blur_px2(z_um - world_.base_um - world_.layer_gap_um);
  const Plane<float> near = near_.blurred(near_px2);
  const Plane<float> coverage = coverage_.blurred(near_px2);
  const Plane<float> far = far_.blurred(blur_px2(z_um - world_.base_um));
  const int first = kMargin_px + request.offset_x;
  const auto light_of_row = [&](int row, float* light) {
    const int y = kMargin_px + request.offset_y + row;
    const float* const near_row = near.row(y) + first;
    const float* const coverage_row = coverage.row(y) + first;
    const float* const far_row = far.row(y) + first;
    for (int x = 0; x < request.width; ++x) light[x] = near_row[x] + (1.0F - coverage_row[x]) * far_row[x];
  };
  sensor_.expose(request, 1.0F, light_of_row, out);
}

}  // namespace fvd::sim
