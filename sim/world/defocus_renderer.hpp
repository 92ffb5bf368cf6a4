#pragma once

/// Slices of a surface as a microscope sees them: every pixel takes the texture blurred by its own defocus.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.hpp"
#include "sim/world/gaussian_transfer.hpp"
#include "sim/world/sensor.hpp"
#include "sim/world/slice_renderer.hpp"

namespace fvd::sim {

struct RendererOptions {
  double defocus_px_per_um = 0.04;
  double readout_noise = 1.5;  ///< standard deviation in 8-bit grey levels
  std::uint64_t seed = 1;
  double sigma_max_px = 12.0;  ///< larger blurs are rendered as this one: no texture is left
  int threads = 2;
};

/// (Gaussian of sigma(x) * texture)(x), sigma = defocus_px_per_um |z - h(x)|, as a sensor sees it. The blurred textures
/// are precomputed at the nodes of TransferNodes as 16-bit values of 1/64 grey level: two bytes per pixel and node,
/// about 36 nodes. Right where heights change little within the blur; at an edge a blur by each pixel's own height lets
/// no light over it: see LayeredRenderer. context: one thread.
class DefocusRenderer final : public SliceRenderer {
 public:
  /// texture in 8-bit grey levels within -255..511, height_um of the same shape; both are copied into the renderer's
  /// tables.
  DefocusRenderer(const Plane<float>& texture, const Plane<float>& height_um, const RendererOptions& options);

  void render(double z_um, const ExposureRequest& request, std::span<std::byte> out) override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  void light_of_row(int row, double z_um, const ExposureRequest& request, float* light) const;

  int width_;
  RendererOptions options_;
  std::vector<std::int16_t> levels_;  // [node][height][width], the blurred texture
  std::vector<float> height_um_;
  std::vector<TransferWeights> weights_;  // over sigma, finely
  Sensor sensor_;
};

}  // namespace fvd::sim
