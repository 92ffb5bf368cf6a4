#pragma once

/// Every frame that was asked for ends in exactly one of five accounts.

#include <cstdint>

namespace fvd {

/// expected == ok + incomplete + missing + stale + underrun after every call of the ledger.
struct FrameCounts {
  std::uint64_t expected = 0;    ///< triggers sent, plus frames that came without one
  std::uint64_t ok = 0;          ///< accepted as a slice
  std::uint64_t incomplete = 0;  ///< delivered with missing packets, of the wrong geometry or dated in the future
  std::uint64_t missing = 0;     ///< nothing delivered before the deadline
  std::uint64_t stale = 0;       ///< delivered, but late, repeated, or not exposed after the stage settled
  std::uint64_t underrun = 0;    ///< lost because no buffer of the pool was free

  [[nodiscard]] bool balanced() const { return expected == ok + incomplete + missing + stale + underrun; }
  bool operator==(const FrameCounts&) const = default;
};

/// Books the fate of frames. A trigger is booked when its fate is known, so the books balance after every call.
/// context: one thread.
class FrameLedger {
 public:
  void ok() { close(counts_.ok); }
  void incomplete() { close(counts_.incomplete); }
  void missing() { close(counts_.missing); }
  void underrun() { close(counts_.underrun); }

  /// A good frame arrived that no open trigger is waiting for: the late frame of a trigger that was booked as missing,
  /// or a frame without a trigger.
  void stale() { late(counts_.stale); }

  /// Books a damaged frame on a trigger that was booked as missing. False, and nothing is booked, if there is no such
  /// trigger: the damaged frame then belongs to the open one.
  [[nodiscard]] bool explain_missing_by_incomplete() {
    if (counts_.missing == 0) return false;
    late(counts_.incomplete);
    return true;
  }

  [[nodiscard]] const FrameCounts& counts() const { return counts_; }

 private:
  void close(std::uint64_t& account) {
    ++counts_.expected;
    ++account;
  }
  void late(std::uint64_t& account) {
    if (counts_.missing > 0) {
      --counts_.missing;
    } else {
      ++counts_.expected;
    }
    ++account;
  }

  FrameCounts counts_;
};

}  // namespace fvd
