#include "sim/world/defocus_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

namespace fvd::sim {

namespace {

constexpr float kUnitsPerLevel = 64.0F;
/// Steps of the table of weights over sigma: sigma is off by less than 1e-4 px.
constexpr int kWeightSteps = 1 << 16;
constexpr std::size_t kNoiseSize = std::size_t{1} << 20U;

/// splitmix64 (Vigna): spreads neighbouring inputs over all outputs.
std::uint64_t hashed(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31U);
}

}  // namespace

DefocusRenderer::DefocusRenderer(const Plane<float>& texture, const Plane<float>& height_um,
                                 const RendererOptions& options)
    : width_(texture.width()),
      height_(texture.height()),
      options_(options),
      height_um_(height_um.pixels().begin(), height_um.pixels().end()),
      pool_(options.threads) {
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
  std::mt19937_64 random(options.seed + 4242);
  std::normal_distribution<float> normal;
  noise_.resize(kNoiseSize + static_cast<std::size_t>(width_));
  for (std::size_t i = 0; i < noise_.size(); ++i) noise_[i] = i < kNoiseSize ? normal(random) : noise_[i - kNoiseSize];
}

std::size_t DefocusRenderer::memory_bytes() const {
  return levels_.size() * sizeof(std::int16_t) + height_um_.size() * sizeof(float) +
         weights_.size() * sizeof(TransferWeights) + noise_.size() * sizeof(float);
}

template <typename Pixel>
void DefocusRenderer::render_row(int row, double z_um, const ExposureRequest& request, Pixel* out) const {
  const auto steps_per_um = static_cast<float>(options_.defocus_px_per_um / options_.sigma_max_px * kWeightSteps);
  const auto largest = static_cast<float>(max_grey_level(request.format));
  const float scale = (largest + 1.0F) / 256.0F;
  const auto noise_scale = static_cast<float>(options_.readout_noise) * scale;
  const auto gain = static_cast<float>(std::pow(10.0, request.gain_db / 20.0)) * scale / kUnitsPerLevel;
  const std::size_t first = static_cast<std::size_t>(row + request.offset_y) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(request.offset_x);
  const std::uint64_t place =
      hashed(options_.seed ^ hashed(request.exposure_index * 65536U + static_cast<unsigned>(row)));
  const float* noise = noise_.data() + place % kNoiseSize;
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
    const float level =
        w.weight[0] * static_cast<float>(level_at[0]) + w.weight[1] * static_cast<float>(level_at[plane]) +
        w.weight[2] * static_cast<float>(level_at[2 * plane]) + w.weight[3] * static_cast<float>(level_at[3 * plane]);
    const float value = level * gain + noise[x] * noise_scale + 0.5F;
    out[x] = static_cast<Pixel>(std::clamp(value, 0.0F, largest));
  }
}

void DefocusRenderer::render(double z_um, const ExposureRequest& request, std::span<std::byte> out) {
  // A band of rows a task keeps the threads even when another process takes part of a core.
  constexpr int kBandRows = 16;
  const int bands = (request.height + kBandRows - 1) / kBandRows;
  pool_.run(bands, [&](int band) {
    for (int y = band * kBandRows; y < std::min((band + 1) * kBandRows, request.height); ++y) {
      const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(request.width);
      if (request.format == PixelFormat::kMono8) {
        render_row(y, z_um, request, reinterpret_cast<std::uint8_t*>(out.data()) + at);
      } else {
        render_row(y, z_um, request, reinterpret_cast<std::uint16_t*>(out.data()) + at);
      }
    }
  });
}

}  // namespace fvd::sim
