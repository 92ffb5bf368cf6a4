#pragma once

/// A sensor: light becomes pixels, with gain, readout noise and the format's range.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/runtime/worker_pool.hpp"
#include "sim/world/frame_source.hpp"

namespace fvd::sim {

struct SensorOptions {
  double readout_noise = 1.5;  ///< standard deviation in 8-bit grey levels
  std::uint64_t seed = 1;
  int threads = 2;
};

/// Light times the gain, plus noise, rounded and clipped. 16-bit formats scale the 8-bit levels to their range.
///
/// Noise comes from a table of 2^20 normal values; each row of each exposure starts at a hashed index. Rows repeat
/// parts of the table, but two slices have the same noise at the same pixel no more often than by chance, and only that
/// would change a focus curve. The same seed and exposure index give the same noise. context: one thread.
class Sensor {
 public:
  /// Writes the light of one row of the request's region, in units of 1 / units_per_level of an 8-bit grey level;
  /// called from several threads.
  using LightOfRow = std::function<void(int row, float* light)>;

  /// largest_width: of any request, pixels.
  Sensor(int largest_width, const SensorOptions& options);

  void expose(const ExposureRequest& request, float units_per_level, const LightOfRow& light_of_row,
              std::span<std::byte> out);

  [[nodiscard]] std::size_t memory_bytes() const { return noise_.size() * sizeof(float); }

 private:
  template <typename Pixel>
  void expose_row(int row, const ExposureRequest& request, float units_per_level, const float* light, Pixel* out) const;

  SensorOptions options_;
  std::vector<float> noise_;  // standard normal
  WorkerPool pool_;
};

}  // namespace fvd::sim
