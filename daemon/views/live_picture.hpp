#pragma once

/// What the camera sees as a JPEG, encoded once for all who look on.

#include <cstdint>
#include <memory>
#include <string>

#include "core/base/mutex.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

struct LiveJpeg {
  std::uint64_t seq = 0;   ///< counts pictures since the daemon's start
  std::string jpeg;        ///< in grey, at most 1280 pixels a side
  int image_width_px = 0;  ///< of the camera's image
  int image_height_px = 0;
  double z_um = 0.0;
  double focus = 0.0;  ///< mean modified Laplacian of the central region of the whole image, grey levels
  double saturated_fraction = 0.0;
};

/// context: thread-safe; a caller encodes, others wait for that. Ten pictures a second come in the mean, no more.
class LivePicture {
 public:
  /// source outlives it.
  explicit LivePicture(PictureSource& source) : source_(source) {}

  /// The newest picture unless its number is `after`; null where there is none. A smaller number than `after` is of a
  /// daemon that was started anew: it is given too. Throws Error kInternal.
  [[nodiscard]] std::shared_ptr<const LiveJpeg> other_than(std::uint64_t after);

 private:
  PictureSource& source_;
  Mutex mutex_;
  std::shared_ptr<const LiveJpeg> encoded_ FVD_GUARDED_BY(mutex_);  // the newest that somebody asked for
};

}  // namespace fvd
