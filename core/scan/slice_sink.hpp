#pragma once

/// Where the scan hands its slices to.

#include "core/frame.hpp"

namespace fvd {

/// One frame with its measured height.
struct Slice {
  Frame frame;
  double z_um = 0.0;
};

class SliceSink {
 public:
  virtual ~SliceSink() = default;
  /// Never blocks. False = no room; the scan fails, because a silent gap would falsify heights.
  [[nodiscard]] virtual bool try_push(Slice&& slice) = 0;
};

}  // namespace fvd
