#pragma once

/// Many clients that ask at a fixed rate, for a heartbeat or what they are told to ask.

#include <chrono>
#include <string>
#include <vector>

namespace fvd::bench {

struct PingLoad {
  int clients = 8;
  int calls_per_s = 2000;  ///< of all clients together
  std::chrono::seconds duration{10};
  /// Lines without their ends, asked in turns; not empty.
  std::vector<std::string> requests{R"({"jsonrpc":"2.0","id":1,"method":"system.ping"})"};
};

/// Duration of each call in ms, from the time at which it was due: a call that had to wait for the one before includes
/// the wait. Throws std::runtime_error if a client cannot connect, and for an answer that is missing or an error.
[[nodiscard]] std::vector<double> ping_times_ms(int port, const PingLoad& load);

/// fraction: 0..1, e.g. 0.99; values: not empty.
[[nodiscard]] double percentile(std::vector<double> values, double fraction);

}  // namespace fvd::bench
