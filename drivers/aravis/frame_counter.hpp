#pragma once

/// Block ids that do not wrap, from the camera's, which do.

#include <cstdint>

namespace fvd {

/// GigE Vision 1.x numbers blocks 1..65535 and never uses 0; after 65535 comes 1. Numbers above 65535 (extended ids,
/// USB3 Vision) are taken as they are. The result grows with every newer block, across wraps and restarts.
class FrameCounter {
 public:
  /// To be called before the first block of a new count of the camera.
  void restart() {
    base_ = last_;
    previous_ = 0;
  }

  /// The newest, 0 before the first.
  [[nodiscard]] std::uint64_t last() const { return last_; }

  /// An older number than the one before (a late frame) gives a smaller result.
  [[nodiscard]] std::uint64_t unwrap(std::uint64_t block) {
    if (block > kPeriod) return last_ = base_ + block;
    if (previous_ == 0) {
      previous_ = block;
      return last_ = base_ + block;
    }
    const std::uint64_t ahead = (block + kPeriod - previous_) % kPeriod;
    if (ahead > kPeriod / 2) {  // late: the newest stays the reference
      const std::uint64_t behind = kPeriod - ahead;
      return last_ > behind ? last_ - behind : 0;
    }
    previous_ = block;
    return last_ += ahead;
  }

 private:
  static constexpr std::uint64_t kPeriod = 65535;
  std::uint64_t base_ = 0;
  std::uint64_t previous_ = 0;  // camera's number of the newest block, 0 = none
  std::uint64_t last_ = 0;
};

}  // namespace fvd
