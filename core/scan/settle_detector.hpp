#pragma once

/// Decides from a stream of samples when an axis has arrived.

#include "core/hw/axis.hpp"

namespace fvd {

/// A driver feeds it with samples; one detector per move. One sample that does not meet the criterion restarts the
/// count, because the first entry into the window is not the end of the ringing. context: one thread.
class SettleDetector {
 public:
  SettleDetector(Micrometers target, const SettleCriterion& criterion) : target_(target), criterion_(criterion) {}

  /// at_rest: the drive reports no motion and, if it can, in position. True once the axis has settled.
  [[nodiscard]] bool add(HostTime time, Micrometers position, bool at_rest) {
    if (!at_rest || !(abs(position - target_) <= criterion_.window)) {  // nor for a position that is no number
      count_ = 0;
      return false;
    }
    if (count_ == 0) first_ = time;
    ++count_;
    return count_ >= criterion_.samples && time - first_ >= criterion_.dwell;
  }

 private:
  Micrometers target_;
  SettleCriterion criterion_;
  HostTime first_{};  // of the samples counted
  int count_ = 0;
};

}  // namespace fvd
