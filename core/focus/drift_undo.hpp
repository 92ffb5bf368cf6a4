#pragma once

/// Undoes the lateral drift of a stack while its slices stream: each is shifted by whole pixels, none is resampled.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/focus/fit/height_map.hpp"
#include "core/focus/judge/slice_drift.hpp"
#include "core/focus/streaming_focus_stack.hpp"

namespace fvd {

/// Rows and columns along the border that not every slice shows, in pixels.
struct HiddenBorder {
  int left = 0;
  int right = 0;
  int top = 0;
  int bottom = 0;
  bool operator==(const HiddenBorder&) const = default;
};

/// context: one thread.
class DriftUndo {
 public:
  /// path: of the stack's slices; empty = every slice stays as it is.
  explicit DriftUndo(DriftPath path) : path_(std::move(path)) {}

  /// Shifts those of a batch that need it. Their pixels are copies then, which live until the next call; what has no
  /// pixels of its own there is mirrored at the border, with the noise and the texture of the image.
  void apply(std::vector<ZSlice>& batch);

  /// Of all slices so far.
  [[nodiscard]] const HiddenBorder& border() const noexcept { return border_; }

 private:
  DriftPath path_;
  HiddenBorder border_;
  std::vector<std::vector<std::byte>> pixels_;  // of each place in a batch
  std::vector<std::vector<std::uint8_t>> colours_;
};

/// Makes holes of the points that not every slice shows, and of those whose window reaches there. reach_px: of the
/// window and of its operator.
void hide_border(HeightMap& map, const HiddenBorder& border, int reach_px);

}  // namespace fvd
