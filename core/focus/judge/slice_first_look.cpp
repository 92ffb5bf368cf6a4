#include "core/focus/judge/slice_first_look.hpp"

#include <cmath>
#include <utility>

#include "core/focus/judge/slice_compare.hpp"

namespace fvd {

namespace {

constexpr double kLeastLight = 0.4;        // over the slice before
constexpr double kDarkFirst = 1.0 / 16.0;  // of full scale
constexpr double kSameDark = 0.2;          // two dark slices are as dark as each other within this share

SuspectSlice doubted(SuspectReason reason, double figure) {
  SuspectSlice slice;
  slice.reason = reason;
  slice.figure = figure;
  return slice;
}

}  // namespace

std::optional<SuspectSlice> SliceFirstLook::compare(const SliceFigures& figures, const ImageView& slice,
                                                    std::uint64_t hash, bool comes_again) {
  if (one_level(figures) && is_constant(slice)) {
    return doubted(SuspectReason::kConstant, figures.samples.front() / figures.full_scale);
  }
  if (!believed_) {
    const double brightness = figures.brightness();
    if (brightness > kDarkFirst * figures.full_scale || !comes_again) return std::nullopt;
    if (doubted_dark_ && std::abs(brightness - *doubted_dark_) <= kSameDark * *doubted_dark_) {
      withdrew_ = true;
      return std::nullopt;
    }
    doubted_dark_ = brightness;
    return doubted(SuspectReason::kDark, brightness / figures.full_scale);
  }
  if (same_samples(figures, *believed_) && hash == believed_hash_) return doubted(SuspectReason::kRepeated, 1.0);
  const double missing = missing_share(figures, *believed_, rows_);
  if (missing > 0.0) return doubted(SuspectReason::kPartial, missing);
  const double light = brightness_ratio(figures, believed_->means);
  if (light > 0.0 && light < kLeastLight) return doubted(SuspectReason::kDark, light);
  return std::nullopt;
}

std::optional<SuspectSlice> SliceFirstLook::doubt(const ImageView& slice, int index, double z_um, bool comes_again) {
  withdrew_ = false;
  SliceFigures figures = slice_figures(slice);
  if (figures.tiles() == 0) return std::nullopt;
  const std::uint64_t hash = content_hash(slice);
  std::optional<SuspectSlice> suspect = compare(figures, slice, hash, comes_again);
  if (suspect) {
    suspect->index = index;
    suspect->z_um = z_um;
  } else {
    if (believed_) rows_.compare(*believed_, figures);
    believed_ = std::move(figures);
    believed_hash_ = hash;
  }
  return suspect;
}

}  // namespace fvd
