#include "sim/world/defocus_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fvd::sim {

namespace {

constexpr float kUnitsPerLevel = 64.0F;
/// Steps of the table of weights over sigma: sigma is off by less than 1e-4 px.
constexpr int kWeightSteps = 1 << 16;

}  // namespace

DefocusRenderer::DefocusRenderer(const Plane<float>& texture, const Plane<float>& height_um,
                                 const RendererOptions& options)
    : width_(texture.width()),
      options_(options),
      height_um_(height_um.pixels().begin(), height_um.pixels().end()),
      sensor_(width_, {.readout_noise = options.readout_noise, .seed = options.seed, .threads = options.threads}) {
  const TransferNodes nodes(options.sigma_max_px);
  const FrequencyBlur blur(texture);
  levels_.reserve(nodes.t().size() * texture.pixels().size());
  for (const double t : nodes.t()) {
    const Plane<float> blurred = blur.blurred(t);
    std::transform(blurred.pixels().begin(), blurred.pixels().end(), std::back_inserter(levels_),
                   [](float value) { return static_cast<std::int16_t>(std::lround(value * kUnitsPerLevel)); });
  }
  weights_.resize(kWeightSteps + 1);
  for (int i = 0; i <= kWeightSteps; ++i) {
    weights_[static_cast<std::size_t>(i)] = nodes.at(options.sigma_max_px * i / kWeightSteps);
  }
}

std::size_t DefocusRenderer::memory_bytes() const {
  return levels_.size() * sizeof(std::int16_t) + height_um_.size() * sizeof(float) +
         weights_.size() * sizeof(TransferWeights) + sensor_.memory_bytes();
}

void DefocusRenderer::light_of_row(int row, double z_um, const ExposureRequest& request, float* light) const {
  const auto steps_per_um = static_cast<float>(options_.defocus_px_per_um / options_.sigma_max_px * kWeightSteps);
  const std::size_t first = static_cast<std::size_t>(row + request.offset_y) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(request.offset_x);
  const auto z = static_cast<float>(z_um);
  const std::int16_t* const levels = levels_.data();
  const TransferWeights* const weights = weights_.data();
  const float* const heights = height_um_.data();
  const std::size_t plane = height_um_.size();
  for (int x = 0; x < request.width; ++x) {
    const std::size_t i = first + static_cast<std::size_t>(x);
    const float step = std::min(std::abs(z - heights[i]) * steps_per_um, static_cast<float>(kWeightSteps));
    // Not negative, and lround() is no vector instruction. NOLINTNEXTLINE(bugprone-incorrect-roundings)
    const TransferWeights& w = weights[static_cast<int>(step + 0.5F)];
    const std::int16_t* level_at = levels + static_cast<std::size_t>(w.first) * plane + i;
    light[x] = w.weight[0] * static_cast<float>(level_at[0]) + w.weight[1] * static_cast<float>(level_at[plane]) +
               w.weight[2] * static_cast<float>(level_at[2 * plane]) +
               w.weight[3] * static_cast<float>(level_at[3 * plane]);
  }
}

void DefocusRenderer::render(double z_um, const ExposureRequest& request, std::span<std::byte> out) {
  sensor_.expose(
      request, kUnitsPerLevel, [&](int row, float* light) { light_of_row(row, z_um, request, light); }, out);
}

}  // namespace fvd::sim
