#pragma once

/// Keeps the newest slice of a scan as a small picture for viewers.

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// A picture of at most 640 x 480 pixels, 8 bit.
struct PreviewPicture {
  std::uint64_t seq = 0;  ///< counts pictures
  Plane<std::uint8_t> pixels;
  double z_um = 0.0;
  double focus = 0.0;  ///< mean modified Laplacian of the central region of the whole image, grey levels
  double saturated_fraction = 0.0;
};

/// Scales the image down by a whole factor; a pixel of the picture is the mean of the pixels it covers.
[[nodiscard]] PreviewPicture make_preview(const ImageView& image, double z_um);

/// {"seq", "width_px", "height_px", "z_um", "focus", "saturated_fraction", "png_base64"} as a JSON text.
[[nodiscard]] std::string preview_json(const PreviewPicture& picture);

/// A measurement offers its slices and never waits. context: thread-safe.
class PreviewHub {
 public:
  /// Skips the slice if there is no viewer, the last picture is younger than 0.2 s, or the lock is taken.
  void offer(const ImageView& image, double z_um);
  /// The newest picture as preview_json(); nothing before the first. The caller counts as a viewer for 3 s.
  [[nodiscard]] std::optional<std::string> newest();
  /// Drops the picture: it belongs to a scan that is over.
  void clear();

 private:
  std::atomic<HostTime> wanted_until_{HostTime{}};
  Mutex mutex_;
  std::optional<PreviewPicture> newest_ FVD_GUARDED_BY(mutex_);
  HostTime taken_ FVD_GUARDED_BY(mutex_){};
  std::uint64_t seq_ FVD_GUARDED_BY(mutex_) = 0;
};

}  // namespace fvd
