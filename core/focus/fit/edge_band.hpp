#pragma once

/// The strip beside a wall in which the stronger side's sharpness reaches across it.
///
/// A window that lies beside a wall and reaches over it sees the sharper side, at that side's height: so does every
/// point up to where the sharper side's share of the window is less than the other's own, and the wall is measured too
/// far out by as much. Where the heights of points two pixels apart jump, the strip of that width on the sharper side
/// is no surface that can be believed; between sides that are nearly alike there is a narrow one on both. Insignificant
/// and saturated points do not count, nor do those of narrow curves.
///
/// Only tiles in which a height jumps are looked at closely.

#include <cstdint>
#include <functional>
#include <vector>

#include "core/focus/kernels/focus_kernels.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// How much of an edge's sharpness reaches a window whose middle lies n + 1/2 px beyond it, as a share of that at
/// half a pixel; n = 0 .. half a window and the operator's distance, less 1. The operator sees an edge on as many
/// pixels as both its arms are long.
[[nodiscard]] std::vector<double> edge_spill(const FocusSettings& settings);

struct EdgeBandLimits {
  std::vector<double> spill;  ///< see edge_spill
  int most_samples = 0;       ///< of two points two pixels apart; more is a jump
  bool root_code = false;     ///< see sharpness_code.hpp

  /// Largest width of a strip.
  [[nodiscard]] int reach_px() const noexcept { return static_cast<int>(spill.size()); }
};

/// Where heights jump: rows are shown by one thread, each band of rows from top to bottom. Not thread-safe; one
/// instance per band, joined afterwards.
class JumpTiles {
 public:
  JumpTiles(int width, int height, const EdgeBandLimits& limits);

  /// Row y with its reasons; it is compared with the row two above, whose reasons are upper_mask, if that was shown.
  /// Points whose peak is insignificant do not count.
  void look_at(int y, const std::uint16_t* peak_index, const MaskReasons* mask, const MaskReasons* upper_mask);
  /// Compares two rows alone, `upper` two above y.
  void compare(int y, const std::uint16_t* upper, const std::uint16_t* lower, const MaskReasons* upper_mask,
               const MaskReasons* lower_mask);
  void join(const JumpTiles& other);

  [[nodiscard]] int tile_px() const noexcept { return tile_; }
  [[nodiscard]] int columns() const noexcept { return columns_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }
  /// In this tile or one beside it.
  [[nodiscard]] bool near(int column, int row) const noexcept;

 private:
  static constexpr int kApart_px = 2;
  void mark(int x, int y, int count, const std::uint16_t* one, const std::uint16_t* other, const MaskReasons* one_mask,
            const MaskReasons* other_mask);

  int width_;
  int tile_;
  int columns_;
  int rows_;
  std::uint16_t most_;
  int shown_ = 0;                                     // rows
  std::vector<std::uint16_t> last_index_[kApart_px];  // of the rows before, by y % 2
  std::vector<std::uint8_t> jumps_;                   // [rows][columns]
};

/// Condensed curves of row y, valid until the same thread's next call.
using CurvesOfRow = std::function<CurveRow(int thread, int y)>;

/// The points in the strips, as marks of shape [height][width]; empty where there are none.
/// context: computes on the pool.
class EdgeBands {
 public:
  EdgeBands(const JumpTiles& tiles, const EdgeBandLimits& limits, const Plane<MaskReasons>& mask,
            const CurvesOfRow& curves, WorkerPool& pool);
  /// Adds kEdgeBand to the points' reasons and takes their heights.
  void apply(Plane<float>& height_m, Plane<float>& sigma_m, Plane<MaskReasons>& mask, WorkerPool& pool) const;

 private:
  struct Tile {
    int x;
    int y;
    std::vector<std::uint8_t> marks;  // [tile][tile]
  };
  int side_;
  std::vector<Tile> tiles_;
};

}  // namespace fvd
