#include "tests/bench/ping_load.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <stdexcept>
#include <thread>

#include "tests/support/line_client.hpp"

namespace fvd::bench {

namespace {

std::vector<double> one_client(int port, std::chrono::nanoseconds period, const PingLoad& load) {
  LineClient client(port);
  std::vector<double> times_ms;
  std::size_t next = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (auto due = begin; due < begin + load.duration; due += period) {
    std::this_thread::sleep_until(due);
    // A server that has fallen behind that far is not asked any more; what it owes counts as long as it is owed.
    if (std::chrono::steady_clock::now() < begin + 2 * load.duration) {
      const std::string& request = load.requests[next++ % load.requests.size()];
      const std::string answer = client.ask(request);
      if (answer.find("\"result\"") == std::string::npos) throw std::runtime_error(request + ": " + answer);
    }
    times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - due).count());
  }
  return times_ms;
}

}  // namespace

std::vector<double> ping_times_ms(int port, const PingLoad& load) {
  const auto period = std::chrono::nanoseconds(std::chrono::seconds(1)) * load.clients / load.calls_per_s;
  std::vector<std::future<std::vector<double>>> running;
  for (int i = 0; i < load.clients; ++i) {
    running.push_back(std::async(std::launch::async, one_client, port, period, load));
  }
  std::vector<double> all;
  for (auto& client : running) {
    const auto times = client.get();
    all.insert(all.end(), times.begin(), times.end());
  }
  return all;
}

double percentile(std::vector<double> values, double fraction) {
  const auto place = static_cast<std::ptrdiff_t>(std::floor(fraction * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

}  // namespace fvd::bench
