#pragma once

/// Scans of a texture whose contrast falls with the distance from a known surface, and the product's map of them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

struct Scan {
  PixelFormat format = PixelFormat::kMono8;
  int width = 0;
  int height = 0;
  std::vector<std::vector<std::byte>> slices;
  std::vector<double> z_um;

  [[nodiscard]] ImageView slice(std::size_t k) const {
    return {format, width, height, static_cast<std::ptrdiff_t>(width) * bytes_per_pixel(format), slices[k].data()};
  }
};

enum class Surface { kTilted, kStepped, kRandom, kBright };

inline double surface_um(Surface surface, int x, int y) {
  switch (surface) {
    case Surface::kTilted:
      return 10.0 + 0.8 * x + 0.3 * y;
    case Surface::kStepped:
      return x % 20 < 10 ? 20.0 : 45.0;
    case Surface::kRandom:
    case Surface::kBright:  // a good part of its pixels is clipped
      return 30.0;
  }
  return 0.0;
}

inline Scan make_scan(PixelFormat format, Surface surface, int width, int height, int count, unsigned seed) {
  Scan scan{format, width, height, {}, {}};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> jitter(-1.5, 1.5);
  std::vector<double> texture(static_cast<std::size_t>(width * height));
  for (auto& value : texture) value = normal(random);
  const double grey = surface == Surface::kBright ? 225.0 : 128.0;
  const double unit = format == PixelFormat::kMono8 ? 1.0 : 256.0;
  for (int k = 0; k < count; ++k) {
    scan.z_um.push_back(5.0 * k + jitter(random));
    std::vector<std::byte> bytes(texture.size() * static_cast<std::size_t>(bytes_per_pixel(format)));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(y * width + x);
        const double defocus = (scan.z_um.back() - surface_um(surface, x, y)) / 12.0;
        const double contrast = surface == Surface::kRandom ? 30.0 : 30.0 * std::exp(-defocus * defocus);
        const double noise = surface == Surface::kRandom ? 30.0 * normal(random) : normal(random);
        const double level = std::clamp((grey + contrast * texture[i] + noise) * unit, 0.0, 256.0 * unit - 1.0);
        if (format == PixelFormat::kMono8) {
          bytes[i] = static_cast<std::byte>(static_cast<std::uint8_t>(level));
        } else {
          const auto wide = static_cast<std::uint16_t>(level);
          std::memcpy(&bytes[2 * i], &wide, sizeof(wide));
        }
      }
    }
    scan.slices.push_back(std::move(bytes));
  }
  return scan;
}

/// batch: slices pushed together.
inline HeightMap stream(const Scan& scan, const FocusSettings& settings, PeakMethod method, int threads,
                        std::size_t batch = 1) {
  WorkerPool pool(threads);
  StreamingFocusStack stack(scan.width, scan.height, scan.format, settings, pool);
  for (std::size_t first = 0; first < scan.slices.size(); first += batch) {
    std::vector<ZSlice> slices;
    for (std::size_t k = first; k < std::min(first + batch, scan.slices.size()); ++k) {
      slices.push_back({scan.slice(k), scan.z_um[k]});
    }
    stack.push(slices);
  }
  return stack.finish(method);
}

}  // namespace fvd
