#pragma once

/// Keeps the newest picture of what the camera sees, for viewers.

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// At most 1280 pixels a side, 8 bit.
struct PreviewPicture {
  std::uint64_t seq = 0;  ///< counts pictures
  Plane<std::uint8_t> pixels;
  int image_width_px = 0;  ///< of the camera's image
  int image_height_px = 0;
  double z_um = 0.0;
  double focus = 0.0;  ///< mean modified Laplacian of the central region of the whole image, grey levels
  double saturated_fraction = 0.0;
};

/// Scales the image down by a whole factor; a pixel of the picture is the mean of the pixels it covers.
[[nodiscard]] PreviewPicture make_preview(const ImageView& image, double z_um);

/// {"seq", "width_px", "height_px", "z_um", "focus", "saturated_fraction", "png_base64"} as a JSON text: a picture of
/// at most 640 x 480 pixels, made of the given one.
[[nodiscard]] std::string preview_json(const PreviewPicture& picture);

/// Ten pictures a second in the mean. One may come up to 50 ms before its time where the one before was late: of a
/// camera that gives just ten, a strict distance would take every second one only.
class PicturePace {
 public:
  [[nodiscard]] bool is_due(HostTime now) const { return now >= due_; }
  void taken(HostTime now);

 private:
  HostTime due_{};
};

/// A measurement offers its slices and never waits. context: thread-safe.
class PreviewHub {
 public:
  /// Skips the slice if there is no viewer, no picture is due (PicturePace), or the lock is taken.
  void offer(const ImageView& image, double z_um);
  /// Keeps an image that somebody took between the jobs, whether there is a viewer or not.
  std::shared_ptr<const PreviewPicture> take(const ImageView& image, double z_um);
  /// The newest picture; null before the first. The caller counts as a viewer for 3 s.
  [[nodiscard]] std::shared_ptr<const PreviewPicture> newest_picture();
  /// The same as preview_json(), which is made on the caller's thread.
  [[nodiscard]] std::optional<std::string> newest();
  /// Drops the picture: it belongs to a scan that is over. The numbers of pictures go on.
  void clear();

 private:
  std::atomic<HostTime> wanted_until_{HostTime{}};
  Mutex mutex_;
  std::shared_ptr<const PreviewPicture> newest_ FVD_GUARDED_BY(mutex_);
  PicturePace pace_ FVD_GUARDED_BY(mutex_);
  std::uint64_t seq_ FVD_GUARDED_BY(mutex_) = 0;
};

}  // namespace fvd
