#pragma once

/// Slices of a surface as a microscope sees them: every pixel takes the texture blurred by its own defocus.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.hpp"
#include "core/runtime/worker_pool.hpp"
#include "sim/world/frame_source.hpp"
#include "sim/world/gaussian_transfer.hpp"

namespace fvd::sim {

struct RendererOptions {
  double defocus_px_per_um = 0.04;
  double readout_noise = 1.5;  ///< standard deviation in 8-bit grey levels
  std::uint64_t seed = 1;
  double sigma_max_px = 12.0;  ///< larger blurs are rendered as this one: no texture is left
  int threads = 2;
};

/// out(x) = (Gaussian of sigma(x) * texture)(x), sigma = defocus_px_per_um |z - h(x)|, plus readout noise, rounded and
/// clipped. The blurred textures are precomputed at the nodes of TransferNodes as 16-bit values of 1/64 grey level: two
/// bytes per pixel and node, about 36 nodes.
///
/// Noise comes from a table of 2^20 normal values; each row of each exposure starts at a hashed index. Rows repeat
/// parts of the table, but two slices have the same noise at the same pixel no more often than by chance, and only that
/// would change a focus curve. The same seed and exposure index give the same noise. context: one thread.
class DefocusRenderer {
 public:
  /// texture in 8-bit grey levels within -255..511, height_um of the same shape; both are copied into the renderer's
  /// tables.
  DefocusRenderer(const Plane<float>& texture, const Plane<float>& height_um, const RendererOptions& options);

  /// Renders the region with the focal plane at z_um. 16-bit formats scale the 8-bit levels to their range.
  void render(double z_um, const ExposureRequest& request, std::span<std::byte> out);

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  template <typename Pixel>
  void render_row(int row, double z_um, const ExposureRequest& request, Pixel* out) const;

  int width_;
  int height_;
  RendererOptions options_;
  std::vector<std::int16_t> levels_;  // [node][height][width], the blurred texture
  std::vector<float> height_um_;
  std::vector<TransferWeights> weights_;  // over sigma, finely
  std::vector<float> noise_;              // standard normal
  WorkerPool pool_;
};

}  // namespace fvd::sim
