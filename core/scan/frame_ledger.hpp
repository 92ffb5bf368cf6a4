#pragma once

/// Every frame that was asked for ends in exactly one of five accounts.

#include <cstdint>

namespace fvd {

/// expected == ok + incomplete + missing + stale + underrun, at all times between two calls of FrameLedger.
struct FrameCounts {
  std::uint64_t expected = 0;    ///< triggers sent, plus frames that came without one
  std::uint64_t ok = 0;          ///< accepted as a slice
  std::uint64_t incomplete = 0;  ///< delivered with missing packets or of the wrong geometry
  std::uint64_t missing = 0;     ///< nothing delivered before the deadline
  std::uint64_t stale = 0;       ///< delivered, but not exposed after the stage settled, late or repeated
  std::uint64_t underrun = 0;    ///< lost because no buffer of the pool was free

  [[nodiscard]] bool balanced() const {
    return expected == ok + incomplete + missing + stale + underrun;
  }
  bool operator==(const FrameCounts&) const = default;
};

}  // namespace fvd
