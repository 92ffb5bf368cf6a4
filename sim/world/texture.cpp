#include "sim/world/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>

#include "sim/world/gaussian_transfer.hpp"

namespace fvd::sim {

namespace {

/// Grain sizes (sigma of the smoothing in pixels) and how much each contributes.
struct Octave {
  double sigma_px;
  double weight;
};
constexpr std::array<Octave, 4> kGranite{{{0.6, 0.80}, {1.2, 0.45}, {3.0, 0.30}, {8.0, 0.25}}};
constexpr std::array<Octave, 1> kFine{{{0.6, 1.0}}};
constexpr std::array<Octave, 1> kWhite{{{0.0, 1.0}}};

std::span<const Octave> octaves(TextureKind kind) {
  switch (kind) {
    case TextureKind::kGranite:
      return kGranite;
    case TextureKind::kFine:
      return kFine;
    case TextureKind::kWhite:
      return kWhite;
  }
  return kGranite;
}

double sample_sd(const Plane<float>& plane) {
  double sum = 0.0;
  double squares = 0.0;
  for (const float value : plane.pixels()) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const auto count = static_cast<double>(plane.pixels().size());
  return std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
}

}  // namespace

Plane<float> make_texture(TextureKind kind, const Plane<float>& share, double contrast, std::uint64_t seed) {
  const int width = share.width();
  const int height = share.height();
  Plane<float> texture(width, height);
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal;
  for (const Octave& octave : octaves(kind)) {
    Plane<float> white(width, height);
    for (float& value : white.pixels()) value = normal(random);
    const Plane<float> grains = FrequencyBlur(white).blurred(octave.sigma_px * octave.sigma_px);
    const double sd = sample_sd(grains);
    const auto factor = static_cast<float>(sd > 0 ? octave.weight / sd : 0.0);
    for (std::size_t i = 0; i < texture.pixels().size(); ++i) texture.pixels()[i] += factor * grains.pixels()[i];
  }
  const double sd = sample_sd(texture);
  const auto scale = static_cast<float>(sd > 0 ? contrast / sd : 0.0);
  const auto limit = static_cast<float>(4.0 * contrast);
  for (std::size_t i = 0; i < texture.pixels().size(); ++i) {
    texture.pixels()[i] = 128.0F + share.pixels()[i] * std::clamp(texture.pixels()[i] * scale, -limit, limit);
  }
  return texture;
}

Plane<float> make_texture(TextureKind kind, const Plane<std::uint8_t>& poor, double contrast, double poor_contrast,
                          std::uint64_t seed) {
  Plane<float> share(poor.width(), poor.height());
  std::ranges::transform(poor.pixels(), share.pixels().begin(),
                         [&](std::uint8_t is_poor) { return is_poor != 0 ? static_cast<float>(poor_contrast) : 1.0F; });
  return make_texture(kind, share, contrast, seed);
}

}  // namespace fvd::sim
