#include "drivers/modbus/modbus_link.hpp"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include <pthread.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int kReadAttempts = 3;
constexpr std::size_t kLatencySamples = 1024;

struct Request {
  ModbusRequest what;
  int attempts_left = 1;
  std::promise<ModbusReply> done;
};

}  // namespace

struct ModbusLink::Impl {
  explicit Impl(const ModbusLinkConfig& config) : transport(config) {
    std::string reason;
    if (!transport.connect(reason)) {
      throw Error(ErrorCode::kStageDisconnected, "no Modbus connection to " + transport.description() + ": " + reason +
                                                     "; is the drive switched on and its address right?");
    }
    thread = std::jthread([this](std::stop_token stop) { run(stop); });
    pthread_setname_np(thread.native_handle(), "fvd-modbus");
  }

  void run(std::stop_token stop) {
    for (;;) {
      resolve_doubt(stop);
      auto request = next(stop);
      if (!request) break;
      ModbusReply reply = attempt(*request);
      if (reply.outcome == ModbusOutcome::kUnknown && --request->attempts_left > 0 && !stop.stop_requested()) {
        const std::lock_guard lock(mutex);
        ++statistics.retries;
        normal.push_front(std::move(*request));  // what is urgent still goes first
        continue;
      }
      request->done.set_value(std::move(reply));
    }
    const std::lock_guard lock(mutex);
    for (auto* queue : {&urgent, &normal}) {
      for (Request& request : *queue)
        request.done.set_value({ModbusOutcome::kUnknown, "the link is being closed", {}, {}});
      queue->clear();
    }
    closed = true;
  }

  std::optional<Request> next(std::stop_token stop) {
    std::unique_lock lock(mutex);
    if (!arrived.wait(lock, stop, [this] { return !urgent.empty() || !normal.empty(); }) || stop.stop_requested()) {
      return std::nullopt;
    }
    auto& queue = urgent.empty() ? normal : urgent;
    Request request = std::move(queue.front());
    queue.pop_front();
    return request;
  }

  ModbusReply attempt(const Request& request) {
    ModbusReply reply;
    if (!transport.connected()) {
      {
        const std::lock_guard lock(mutex);
        ++statistics.reconnects;
      }
      std::string reason;
      if (!transport.connect(reason)) {
        reply.error = "cannot connect: " + reason;
        return book(std::move(reply), SteadyClock::duration::zero());
      }
    }
    const auto begin = SteadyClock::now();
    const auto answer = transport.transact(request.what, reply.values, reply.error);
    const auto end = SteadyClock::now();
    reply.sampled = begin + (end - begin) / 2;
    switch (answer) {
      case ModbusTransport::Answer::kOk:
        reply.outcome = ModbusOutcome::kOk;
        break;
      case ModbusTransport::Answer::kException:
        reply.outcome = ModbusOutcome::kRejected;
        break;
      case ModbusTransport::Answer::kNone:
        doubtful = true;
        break;
    }
    return book(std::move(reply), end - begin);
  }

  /// Before the next request, so that who waits for this one's outcome need not wait for the line's silence.
  void resolve_doubt(std::stop_token stop) {
    if (!doubtful) return;
    doubtful = false;
    const std::size_t discarded = transport.resynchronise([&] {
      const std::lock_guard lock(mutex);
      return stop.stop_requested() || !urgent.empty();
    });
    const std::lock_guard lock(mutex);
    statistics.discarded_bytes += discarded;
  }

  ModbusReply book(ModbusReply reply, SteadyClock::duration latency) {
    const std::lock_guard lock(mutex);
    ++statistics.transactions;
    if (reply.outcome == ModbusOutcome::kUnknown) ++statistics.unknown;
    if (reply.outcome == ModbusOutcome::kRejected) ++statistics.rejected;
    if (reply.outcome != ModbusOutcome::kUnknown) {
      latencies_us[latency_count++ % kLatencySamples] = std::chrono::duration<double, std::micro>(latency).count();
    }
    return reply;
  }

  ModbusReply submit(Request request, ModbusPriority priority) {
    auto reply = request.done.get_future();
    {
      const std::lock_guard lock(mutex);
      if (closed) return {ModbusOutcome::kUnknown, "the link is closed", {}, {}};
      (priority == ModbusPriority::kUrgent ? urgent : normal).push_back(std::move(request));
    }
    arrived.notify_one();
    return reply.get();
  }

  ModbusTransport transport;  // I/O thread only, once it runs
  bool doubtful = false;      // likewise: bytes of an answer may still come
  mutable std::mutex mutex;
  std::condition_variable_any arrived;
  std::deque<Request> urgent;  // this and all below: guarded by mutex
  std::deque<Request> normal;
  bool closed = false;
  ModbusLinkStats statistics;
  std::array<double, kLatencySamples> latencies_us{};
  std::size_t latency_count = 0;
  std::jthread thread;  // last
};

ModbusLink::ModbusLink(const ModbusLinkConfig& config) : impl_(std::make_unique<Impl>(config)) {}
ModbusLink::~ModbusLink() = default;

ModbusReply ModbusLink::read(ModbusTable table, int address, int count, ModbusPriority priority) {
  Request request;
  request.what = {table, address, count, {}, false};
  request.attempts_left = kReadAttempts;
  return impl_->submit(std::move(request), priority);
}

ModbusReply ModbusLink::write(ModbusTable table, int address, std::span<const std::uint16_t> values,
                              ModbusPriority priority, bool single) {
  Request request;
  request.what = {table, address, 0, {values.begin(), values.end()}, single};
  return impl_->submit(std::move(request), priority);
}

ModbusLinkStats ModbusLink::stats() const {
  const std::lock_guard lock(impl_->mutex);
  ModbusLinkStats stats = impl_->statistics;
  std::vector<double> sorted(
      impl_->latencies_us.begin(),
      impl_->latencies_us.begin() + static_cast<std::ptrdiff_t>(std::min(impl_->latency_count, kLatencySamples)));
  std::sort(sorted.begin(), sorted.end());
  if (!sorted.empty()) {
    stats.latency_p50_us = sorted[sorted.size() / 2];
    stats.latency_p99_us = sorted[sorted.size() * 99 / 100];
    stats.latency_max_us = sorted.back();
  }
  return stats;
}

std::string ModbusLink::description() const { return impl_->transport.description(); }

}  // namespace fvd
