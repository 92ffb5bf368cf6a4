#include "drivers/modbus/modbus_link.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/base/exception_text.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "drivers/modbus/modbus_queue.hpp"
#include "drivers/modbus/pause.hpp"
#include "drivers/modbus/rtu_over_tcp.hpp"

namespace fvd {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int kReadAttempts = 3;
constexpr std::size_t kLatencySamples = 1024;
/// Between two attempts of a request that the device puts off.
constexpr std::chrono::milliseconds kFirstPause{4};
constexpr std::chrono::milliseconds kLongestPause{200};
/// With a new connection before it and the line's silence after it: each has a timeout of its own.
constexpr std::chrono::seconds kLongestRequest{60};

}  // namespace

struct ModbusLink::Impl {
  explicit Impl(const ModbusLinkConfig& c) : config(c), transport(c) {
    std::string reason;
    bool renewed = false;
    if (!transport.ensure_connected(false, renewed, reason)) {
      throw Error(ErrorCode::kStageDisconnected, "no Modbus connection to " + transport.description() + ": " + reason +
                                                     "; is the drive switched on and its address right?");
    }
    thread = start_thread(
        "fvd-modbus", [this](const std::stop_token& stop) { run(stop); },
        [this](std::string_view name, const std::exception_ptr& failure) { give_up(name, failure); });
  }

  void run(const std::stop_token& stop) {
    ThreadTicks ticks("fvd-modbus", kLongestRequest);
    for (;;) {
      resolve_doubt(stop);
      ticks.rest();
      auto request = queue.next(stop);
      if (!request) break;
      ticks.tick(HostClock::now());
      ModbusReply reply = attempt(*request);
      const bool is_doubt = reply.outcome == ModbusOutcome::kUnknown && !reply.later;
      if (is_doubt && --request->attempts_left > 0 && !stop.stop_requested()) {
        const MutexLock lock(mutex);
        ++statistics.retries;
        queue.put_back(std::move(*request));  // what is urgent still goes first
        continue;
      }
      request->done.set_value(std::move(reply));
    }
    queue.close("the link is closed");
  }

  /// The thread has ended by an exception: everybody who waits is told.
  void give_up(std::string_view name, const std::exception_ptr& failure) {
    const std::string why = exception_text(failure);
    spdlog::error("thread {} ended by an exception: {}", name, why);
    queue.close("the link has failed: " + why);
  }

  ModbusReply attempt(const QueuedRequest& request) {
    ModbusReply reply;
    bool renewed = false;
    std::string reason;
    const bool connected = transport.ensure_connected(request.what.writes(), renewed, reason);
    if (renewed) {
      const MutexLock lock(mutex);
      ++statistics.reconnects;
    }
    if (!connected) {
      reply.error = "cannot connect: " + reason;
      return book(std::move(reply), SteadyClock::duration::zero());
    }
    const auto begin = SteadyClock::now();
    const auto answer = transport.transact(request.what, reply.values, reply.error);
    const auto end = SteadyClock::now();
    reply.sampled = begin + (end - begin) / 2;
    switch (answer) {
      case PduAnswer::kOk:
        reply.outcome = ModbusOutcome::kOk;
        break;
      case PduAnswer::kException:
        reply.outcome = ModbusOutcome::kRejected;
        break;
      case PduAnswer::kLater:
        reply.later = true;
        break;
      case PduAnswer::kNone:
        doubtful = true;
        break;
    }
    return book(std::move(reply), end - begin);
  }

  /// Before the next request, so that who waits for this one's outcome need not wait for the line's silence.
  void resolve_doubt(const std::stop_token& stop) {
    if (!doubtful) return;
    doubtful = false;
    transport.resynchronise([&] { return stop.stop_requested() || queue.has_urgent(); });
  }

  ModbusReply ask(const ModbusRequest& what, int attempts, bool repeatable, ModbusPriority priority,
                  const std::stop_token& stop) {
    const auto once = [&] {
      QueuedRequest request;
      request.what = what;
      request.attempts_left = attempts;
      return queue.submit(std::move(request), priority);
    };
    return repeatable ? patiently(once, stop) : once();
  }

  /// In the thread of who asks: others' requests go on meanwhile.
  ModbusReply patiently(const std::function<ModbusReply()>& attempt, const std::stop_token& stop) {
    const auto begin = SteadyClock::now();
    for (auto wait = kFirstPause;; wait = std::min(2 * wait, kLongestPause)) {
      ModbusReply reply = attempt();
      if (!reply.later) return reply;
      if (SteadyClock::now() + wait > begin + config.patience) {
        reply.error += ", for " + std::to_string(config.patience.count()) + " ms";
        return reply;
      }
      if (!pause(wait, stop)) return reply;
      const MutexLock lock(mutex);
      ++statistics.retries;
    }
  }

  ModbusReply book(ModbusReply reply, SteadyClock::duration latency) {
    const MutexLock lock(mutex);
    ++statistics.transactions;
    statistics.discarded_bytes += transport.take_discarded();
    if (reply.later) {
      ++statistics.later;
    } else if (reply.outcome == ModbusOutcome::kUnknown) {
      ++statistics.unknown;
    }
    if (reply.outcome == ModbusOutcome::kRejected) ++statistics.rejected;
    if (reply.outcome != ModbusOutcome::kUnknown) {
      latencies_us[latency_count++ % kLatencySamples] = std::chrono::duration<double, std::micro>(latency).count();
    }
    return reply;
  }

  const ModbusLinkConfig config;
  WriteObserver observer;     // set before the first write
  ModbusTransport transport;  // I/O thread only, once it runs
  bool doubtful = false;      // likewise: bytes of an answer may still come
  ModbusQueue queue;
  mutable Mutex mutex;
  ModbusLinkStats statistics FVD_GUARDED_BY(mutex);
  std::array<double, kLatencySamples> latencies_us FVD_GUARDED_BY(mutex){};
  std::size_t latency_count FVD_GUARDED_BY(mutex) = 0;
  std::jthread thread;  // last
};

ModbusLink::ModbusLink(const ModbusLinkConfig& config) : impl_(std::make_unique<Impl>(config)) {}
ModbusLink::~ModbusLink() = default;

ModbusReply ModbusLink::read(ModbusTable table, int address, int count, ModbusPriority priority, std::stop_token stop) {
  return impl_->ask({table, address, count, {}, false}, kReadAttempts, true, priority, stop);
}

ModbusReply ModbusLink::write(ModbusTable table, int address, std::span<const std::uint16_t> values,
                              ModbusPriority priority, ModbusWriting how, std::stop_token stop) {
  const ModbusRequest what{table, address, 0, {values.begin(), values.end()}, how.single};
  if (impl_->observer) impl_->observer(what, false, false);
  ModbusReply reply = impl_->ask(what, 1, how.repeatable, priority, stop);
  if (impl_->observer) impl_->observer(what, true, reply.outcome == ModbusOutcome::kOk);
  return reply;
}

ModbusReply ModbusLink::patiently(const std::function<ModbusReply()>& attempt, const std::stop_token& stop) {
  return impl_->patiently(attempt, stop);
}

void ModbusLink::observe_writes(WriteObserver observer) { impl_->observer = std::move(observer); }

ModbusLinkStats ModbusLink::stats() const {
  const MutexLock lock(impl_->mutex);
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

std::string ModbusLink::advice() const {
  const auto* tcp = std::get_if<ModbusTcpEndpoint>(&impl_->config.endpoint);
  if (tcp == nullptr) return "Is the drive on, and are unit, baud rate and parity right?";
  if (answers_serial_frames(*tcp, impl_->config.unit, impl_->config.response_timeout)) {
    return "It answers serial frames (RTU over TCP): set the serial device server to Modbus TCP, it passes bytes on as "
           "they are.";
  }
  return "The connection was made: is the unit right, the drive behind a gateway on, and does the gateway speak Modbus "
         "TCP and not serial frames (RTU over TCP)?";
}

}  // namespace fvd
