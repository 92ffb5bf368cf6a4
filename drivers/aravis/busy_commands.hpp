#pragma once

/// Commands that a camera answers with GEV_STATUS_BUSY are repeated.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

#include "core/base/clock.hpp"

namespace fvd {

/// A camera that is busy for longer refuses the command.
inline constexpr std::chrono::milliseconds kLongestBusy{2000};

/// Calls `attempt` until it returns false or kLongestBusy is over, with growing pauses. attempt: returns whether the
/// camera was busy. Returns what the last attempt returned. Blocks for kLongestBusy at most, and the attempts.
template <typename Attempt>
bool while_busy(Attempt attempt) {
  const HostTime deadline = HostClock::now() + kLongestBusy;
  for (std::chrono::milliseconds pause{1};; pause = std::min(2 * pause, std::chrono::milliseconds(100))) {
    if (!attempt()) return false;
    if (HostClock::now() + pause > deadline) return true;
    std::this_thread::sleep_for(pause);
  }
}

/// From now on every register and memory access of every GigE Vision device of this process is repeated while the
/// camera is busy. context: any thread; calls after the first do nothing.
void repeat_busy_commands();

/// Number of accesses that were answered with "busy", in this process.
[[nodiscard]] std::uint64_t busy_answers() noexcept;

}  // namespace fvd
