#include "sim/world/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace fvd::sim {

namespace {

constexpr std::size_t kNoiseSize = std::size_t{1} << 20U;

/// splitmix64 (Vigna): spreads neighbouring inputs over all outputs.
std::uint64_t hashed(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31U);
}

}  // namespace

Sensor::Sensor(int largest_width, const SensorOptions& options) : options_(options), pool_(options.threads) {
  std::mt19937_64 random(options.seed + 4242);
  std::normal_distribution<float> normal;
  noise_.resize(kNoiseSize + static_cast<std::size_t>(largest_width));
  for (std::size_t i = 0; i < noise_.size(); ++i) noise_[i] = i < kNoiseSize ? normal(random) : noise_[i - kNoiseSize];
}

template <typename Pixel>
void Sensor::expose_row(int row, const ExposureRequest& request, float units_per_level, const float* light,
                        Pixel* out) const {
  const auto largest = static_cast<float>(max_grey_level(request.format));
  const float scale = (largest + 1.0F) / 256.0F;
  const auto noise_scale = static_cast<float>(options_.readout_noise) * scale;
  const auto gain = static_cast<float>(std::pow(10.0, request.gain_db / 20.0)) * scale / units_per_level;
  const std::uint64_t place =
      hashed(options_.seed ^ hashed(request.exposure_index * 65536U + static_cast<unsigned>(row)));
  const float* noise = noise_.data() + place % kNoiseSize;
  for (int x = 0; x < request.width; ++x) {
    const float value = light[x] * gain + noise[x] * noise_scale + 0.5F;
    out[x] = static_cast<Pixel>(std::clamp(value, 0.0F, largest));
  }
}

void Sensor::expose(const ExposureRequest& request, float units_per_level, const LightOfRow& light_of_row,
                    std::span<std::byte> out) {
  // A band of rows a task keeps the threads even when another process takes part of a core.
  constexpr int kBandRows = 16;
  const int bands = (request.height + kBandRows - 1) / kBandRows;
  pool_.run(bands, [&](int band) {
    std::vector<float> light(static_cast<std::size_t>(request.width));
    for (int y = band * kBandRows; y < std::min((band + 1) * kBandRows, request.height); ++y) {
      light_of_row(y, light.data());
      const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(request.width);
      if (request.format == PixelFormat::kMono8) {
        expose_row(y, request, units_per_level, light.data(), reinterpret_cast<std::uint8_t*>(out.data()) + at);
      } else {
        expose_row(y, request, units_per_level, light.data(), reinterpret_cast<std::uint16_t*>(out.data()) + at);
      }
    }
  });
}

}  // namespace fvd::sim
