#pragma once

/// Slices of a simulated surface, changed one by one, and what the gate makes of them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/focus/judge/slice_gate.hpp"
#include "sim/world/defocus_renderer.hpp"
#include "sim/world/surface.hpp"
#include "sim/world/texture.hpp"

namespace fvd::test {

struct SceneSettings {
  sim::SurfaceKind surface = sim::SurfaceKind::kTilted;
  double contrast = 25.0;
  double step_um = 10.0;
  int slices = 21;
  double base_um = 100.0;
  double tilt_x_um_per_px = 0.3;
  int side_px = 240;
  std::uint64_t seed = 1;
  double noise = 1.5;
};

using Image = Plane<std::uint8_t>;

struct Scene {
  explicit Scene(const SceneSettings& settings) {
    sim::WorldParameters world;
    world.surface = settings.surface;
    world.width_px = world.height_px = settings.side_px;
    world.base_um = settings.base_um;
    world.tilt_x_um_per_px = settings.tilt_x_um_per_px;
    world.contrast = settings.contrast;
    world.seed = settings.seed;
    const sim::Surface made = sim::make_surface(world);
    height_um = made.height_um.clone();
    const auto texture =
        sim::make_texture(sim::TextureKind::kGranite, made.poor, settings.contrast, 1.0, settings.seed);
    sim::RendererOptions options;
    options.seed = settings.seed;
    options.readout_noise = settings.noise;
    renderer_.emplace(texture, made.height_um, options);
    for (int k = 0; k < settings.slices; ++k) {
      z_um.push_back(settings.step_um * k);
      slices.push_back(exposed(z_um.back(), static_cast<std::uint64_t>(k)));
    }
  }

  /// Slice k once more, with other noise.
  [[nodiscard]] Image again(std::size_t k) { return exposed(z_um[k], 1000 + k); }

  [[nodiscard]] ImageView view(std::size_t k) const { return image_view(slices[k].view(), PixelFormat::kMono8); }

  std::vector<Image> slices;
  std::vector<double> z_um;
  Plane<float> height_um;

 private:
  Image exposed(double height, std::uint64_t index) {
    Image image = Image::unset(height_um.width(), height_um.height());
    sim::ExposureRequest request;
    request.width = image.width();
    request.height = image.height();
    request.exposure_index = index;
    renderer_->render(height, request, std::as_writable_bytes(image.pixels()));
    return image;
  }

  std::optional<sim::DefocusRenderer> renderer_;
};

inline std::uint8_t grey(double level) { return static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L)); }

/// Every pixel by change(level, x, y).
template <typename Change>
void change(Image& image, const Change& of) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) image.at(x, y) = grey(of(image.at(x, y), x, y));
  }
}

/// Noise that a dark exposure has: a black level of 8.
inline double dark_level(int x, int y) {
  const auto mixed = static_cast<unsigned>(x) * 7919U + static_cast<unsigned>(y) * 104729U;
  return 8.0 + static_cast<double>(mixed % 97U % 5U) - 2.0;
}

/// Exposed at two places.
inline void shake(Image& image, int dx, int dy) {
  const Image still = image.clone();
  change(image, [&](double level, int x, int y) {
    const int u = std::clamp(x + dx, 0, still.width() - 1);
    const int v = std::clamp(y + dy, 0, still.height() - 1);
    return 0.5 * (level + still.at(u, v));
  });
}

struct Judged {
  std::vector<int> passed;
  std::vector<double> gains;
  std::vector<SuspectSlice> suspects;
  double flicker_percent = 0.0;

  [[nodiscard]] std::vector<int> suspect_indices() const {
    std::vector<int> indices;
    for (const SuspectSlice& slice : suspects) indices.push_back(slice.index);
    return indices;
  }
};

inline Judged judge_scene(const Scene& scene, int allowed = 1000) {
  SliceGate<int> gate(allowed);
  Judged judged;
  const auto pass = [&judged](int&& index, double /*z_um*/, double gain) {
    judged.passed.push_back(index);
    judged.gains.push_back(gain);
  };
  for (std::size_t k = 0; k < scene.slices.size(); ++k) {
    gate.push(static_cast<int>(k), scene.view(k), slice_figures(scene.view(k)), static_cast<int>(k), scene.z_um[k],
              pass);
  }
  gate.finish(pass);
  judged.suspects = gate.suspects();
  judged.flicker_percent = gate.flicker_percent();
  return judged;
}

}  // namespace fvd::test
