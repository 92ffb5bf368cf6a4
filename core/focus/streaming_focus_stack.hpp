#pragma once

/// The product's core: slices in, height map out, memory independent of the number of slices.

#include <cstddef>
#include <memory>
#include <span>

#include "core/focus/fit/height_map.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"

namespace fvd {

class WorkerPool;

/// A slice and the height it was taken at.
struct ZSlice {
  ImageView image;
  double z_um = 0.0;
  const std::uint8_t* colour = nullptr;  ///< shape [height][width][3] contiguous; read by stacks with colour only
  double gain = 1.0;  ///< its light times this is that of the other slices: its sharpness is multiplied, see CodeScale
};

/// Keeps per pixel the peak of the focus curve with two neighbours on either side, the peak's number, and the curve's
/// minimum. Never a slice or a sharpness plane.
/// context: one thread at a time; the work is spread over the pool's threads inside push() and finish().
class StreamingFocusStack {
 public:
  static constexpr int kMaxSlices = 65535;
  static constexpr int kMaxBatch = 8;           ///< slices that are processed together, row by row
  static constexpr double kMaxHeight_um = 1e9;  ///< one kilometre: a larger z is no stage position

  /// Allocates everything it will ever need. width, height >= 1. pool outlives the stack.
  /// colour: every slice comes with its colours, and the map gets an all-in-focus image in colour.
  /// pages: where the memory of state and maps comes from and goes to, if given: the next scan of this size is faster.
  /// Throws Error kBadInput for settings out of range.
  StreamingFocusStack(int width, int height, PixelFormat format, const FocusSettings& settings, WorkerPool& pool,
                      bool colour = false, KeptPagesPtr pages = nullptr);
  ~StreamingFocusStack();
  StreamingFocusStack(StreamingFocusStack&&) noexcept;
  StreamingFocusStack& operator=(StreamingFocusStack&&) noexcept;

  /// Adds one slice at its measured z. Throws Error kBadSlice if size or format differ, colours are missing, z is not a
  /// number within +-kMaxHeight_um, or the stack is full; the stack is unchanged then. Allocates nothing.
  void push(const ImageView& slice, double z_um);

  /// Adds successive slices, with the same result to the bit; faster, because each row's state is loaded and stored
  /// once for up to kMaxBatch of them.
  void push(std::span<const ZSlice> slices);

  [[nodiscard]] int slices() const noexcept;

  /// Bytes of per-pixel state; the same before the first and after the last slice.
  [[nodiscard]] double state_bytes_per_pixel() const noexcept;

  /// Bytes that a scan of this size needs: state, scratch and one height map; without the colours of a stack in colour.
  [[nodiscard]] static std::size_t memory_bytes(int width, int height, PixelFormat format,
                                                const FocusSettings& settings, int threads);

  /// Heights from the state; may be called with several methods. Throws Error kBadSlice if no slice was pushed.
  [[nodiscard]] HeightMap finish(PeakMethod method) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
