#pragma once

/// The consumer of the slices of a scan.

#include <stop_token>

#include "core/image/frame.hpp"

namespace fvd {

/// One frame with its measured height.
struct Slice {
  Frame frame;
  double z_um = 0.0;  ///< stage position measured over the exposure, um
  int index = 0;      ///< of the plan, 0-based
};

class SliceSink {
 public:
  virtual ~SliceSink() = default;
  /// Waits for room until the deadline or until stop is requested. False if the slice was not accepted; the scan then
  /// fails, because a silent gap would falsify heights. context: the scan's thread.
  [[nodiscard]] virtual bool push(Slice&& slice, HostTime deadline, std::stop_token stop) = 0;
};

}  // namespace fvd
