#pragma once

/// What two, three or four slices' figures say of one another. All figures are of the same grid.

#include <optional>
#include <vector>

#include "core/focus/judge/slice_figures.hpp"

namespace fvd {

/// Brightness of a slice over that of a reference: the mean over the tiles whose ratio is near the median of all, which
/// glints, edges and clipped tiles do not move. reference: grey levels of the tiles. 0 where nothing is comparable.
[[nodiscard]] double brightness_ratio(const SliceFigures& slice, const std::vector<double>& reference);

/// The samples are identical to the bit.
[[nodiscard]] bool same_samples(const SliceFigures& a, const SliceFigures& b) noexcept;

/// All samples have the same grey level.
[[nodiscard]] bool one_level(const SliceFigures& slice) noexcept;

/// Which rows of tiles change from slice to slice. What never changes, a scale bar or a masked region, is no sign of a
/// slice that came in part.
class LivingRows {
 public:
  /// Two slices that follow each other.
  void compare(const SliceFigures& slice, const SliceFigures& next);
  [[nodiscard]] bool lives(int row) const noexcept {
    return static_cast<std::size_t>(row) < lives_.size() && lives_[static_cast<std::size_t>(row)];
  }

 private:
  std::vector<bool> lives_;
};

/// Share of the rows, at the top or at the bottom, that hold no signal of their own while the rest does: 0 for a whole
/// slice. reference: a slice nearby that is believed.
[[nodiscard]] double missing_share(const SliceFigures& slice, const SliceFigures& reference, const LivingRows& rows);

/// Whether slices follow each other in the order before, first, second, after: the correlation, tile by tile, of the
/// change from first to second with the change from before to after. Slices in order change in the same direction over
/// one step as over three about it, also where they are symmetric about the focus; noise has no correlation.
struct OrderFigure {
  double correlation = 0.0;     ///< mean over the tiles, -1..1
  double negative_share = 0.0;  ///< of the tiles
  double significance = 0.0;    ///< the mean over its standard error
  /// Certain that first and second are not in order.
  [[nodiscard]] bool reversed() const noexcept;
  /// Certain that they are.
  [[nodiscard]] bool in_order() const noexcept;
};
[[nodiscard]] OrderFigure order_of(const SliceFigures& before, const SliceFigures& first, const SliceFigures& second,
                                   const SliceFigures& after);

/// Whether two slices amid others have changed places: the four about them are in the order of the scan only if they
/// are exchanged back, and their distances say the same. Lateral jitter, which also makes slices differ at random, does
/// not do all of that.
[[nodiscard]] bool exchanged(const SliceFigures& before2, const SliceFigures& before, const SliceFigures& first,
                             const SliceFigures& second, const SliceFigures& after, const SliceFigures& after2);

/// Whether the step from first to second, of four slices that follow each other, is noise alone: second was taken where
/// first was. Judged in tiles that change over the steps before and after it, where a stage that moved would have
/// changed them; the product of both differences, of four exposures, has no part of the noise. About the focus of a
/// flat surface, where two slices may be alike, so are the other two.
struct StandstillFigure {
  double change = 1.0;  ///< of the step over that of all three about it; near a third for even steps, 0 for none
  double share = 0.0;   ///< of the tiles, that say so
  [[nodiscard]] bool stood_still() const noexcept;
};
[[nodiscard]] StandstillFigure standstill_of(const SliceFigures& before, const SliceFigures& first,
                                             const SliceFigures& second, const SliceFigures& after);

/// Whether a slice is as sharp, in every direction, as its neighbours let expect.
struct MotionFigure {
  int tiles = 0;              ///< those in which both neighbours show texture well above the noise
  double share = 0.0;         ///< of all tiles
  double direction = 0.0;     ///< |logarithm| by which the ratio of two crossed directions differs from the neighbours'
  double significance = 0.0;  ///< that over its standard error
  double sharpness = 0.0;     ///< logarithm of the sharpness over the neighbours' geometric mean
  /// Correlation of what either neighbour has and the slice lacks: near 1 for a slice that was smeared. Between two
  /// levels of a surface each neighbour has the texture of its own level, and it is below 0.
  double agreement = 0.0;
  /// Certain that the slice is blurred in one direction: no other order of slices makes that.
  [[nodiscard]] bool turned() const noexcept;
  /// Certain that the slice was moved or exposed twice.
  [[nodiscard]] bool moved() const noexcept;
  /// The larger of the two, to compare slices by.
  [[nodiscard]] double strength() const noexcept;
};
/// noise: mean squared second difference that noise makes, of each tile.
[[nodiscard]] MotionFigure motion_of(const SliceFigures& before, const SliceFigures& slice, const SliceFigures& after,
                                     const std::vector<double>& noise);

}  // namespace fvd
