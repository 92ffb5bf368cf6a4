#pragma once

/// Where the scan hands its slices to.

#include <stop_token>

#include "core/image/frame.hpp"

namespace fvd {

/// One frame with its measured height.
struct Slice {
  Frame frame;
  double z_um = 0.0;
};

class SliceSink {
 public:
  virtual ~SliceSink() = default;
  /// Waits for room until the deadline or until stop is requested. False = not taken; the scan fails then, because a
  /// silent gap would falsify heights.
  [[nodiscard]] virtual bool push(Slice&& slice, HostTime deadline, std::stop_token stop) = 0;
};

}  // namespace fvd
