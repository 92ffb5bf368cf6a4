#pragma once

/// Judges a slice while the stage still stands at its height, by itself and by the slice before alone.

#include <cstdint>
#include <optional>

#include "core/focus/judge/slice_compare.hpp"
#include "core/focus/judge/slice_figures.hpp"
#include "core/focus/judge/suspect_slice.hpp"

namespace fvd {

/// context: one thread.
class SliceFirstLook {
 public:
  /// What speaks against the slice; nothing = it may be believed, and is what the next is compared with. A dark slice
  /// that comes first, or comes again as dark as before, is a dark scene: it is doubted once, if it can come again.
  [[nodiscard]] std::optional<SuspectSlice> doubt(const ImageView& slice, int index, double z_um,
                                                  bool comes_again = true);

  /// The last slice was believed although the one before it was doubted as dark: the scene is as dark as that.
  [[nodiscard]] bool withdrew() const noexcept { return withdrew_; }

 private:
  [[nodiscard]] std::optional<SuspectSlice> compare(const SliceFigures& figures, const ImageView& slice,
                                                    std::uint64_t hash, bool comes_again);

  std::optional<SliceFigures> believed_;
  LivingRows rows_;
  std::uint64_t believed_hash_ = 0;
  std::optional<double> doubted_dark_;  // brightness of the first slice, grey levels
  bool withdrew_ = false;
};

}  // namespace fvd
