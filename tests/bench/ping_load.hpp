#pragma once

/// Many clients that ask for a heartbeat at a fixed rate.

#include <chrono>
#include <vector>

namespace fvd::bench {

struct PingLoad {
  int clients = 8;
  int calls_per_s = 2000;  ///< of all clients together
  std::chrono::seconds duration{10};
};

/// How long each call took in ms, counted from when it was due: a call that had to wait for the one before counts its
/// waiting. Throws std::runtime_error if a client cannot connect.
[[nodiscard]] std::vector<double> ping_times_ms(int port, const PingLoad& load);

/// fraction: 0..1, e.g. 0.99; the list is not empty.
[[nodiscard]] double percentile(std::vector<double> values, double fraction);

}  // namespace fvd::bench
