#pragma once

/// The streaming stack's obviously correct twin: keeps every slice's sharpness and evaluates the whole curve at the
/// end. Memory grows with the number of slices; for tests.

#include <vector>

#include "core/focus/fit/height_map.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// Same results, bit for bit, as StreamingFocusStack on the same slices. context: one thread.
class SimpleFocusStack {
 public:
  /// Throws Error kBadInput for settings out of range.
  explicit SimpleFocusStack(const FocusSettings& settings);

  /// All slices of the first one's size and format. gain: see ZSlice.
  void push(const ImageView& slice, double z_um, double gain = 1.0);

  /// Throws Error kBadSlice without slices.
  [[nodiscard]] HeightMap finish(PeakMethod method) const;

 private:
  FocusSettings settings_;
  PixelFormat format_ = PixelFormat::kMono8;
  std::vector<Plane<std::uint16_t>> sharpness_;  // codes
  std::vector<Plane<std::uint16_t>> pixels_;
  std::vector<double> z_um_;
};

}  // namespace fvd
