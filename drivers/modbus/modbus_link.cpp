#include "drivers/modbus/modbus_link.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "drivers/modbus/modbus_queue.hpp"

namespace fvd {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int kReadAttempts = 3;
constexpr std::size_t kLatencySamples = 1024;

}  // namespace

struct ModbusLink::Impl {
  explicit Impl(const ModbusLinkConfig& config) : transport(config) {
    std::string reason;
    if (!transport.connect(reason)) {
      throw Error(ErrorCode::kStageDisconnected, "no Modbus connection to " + transport.description() + ": " + reason +
                                                     "; is the drive switched on and its address right?");
    }
    thread = start_thread(
        "fvd-modbus", [this](const std::stop_token& stop) { run(stop); },
        [this](std::string_view name, const std::exception_ptr& failure) { give_up(name, failure); });
  }

  void run(const std::stop_token& stop) {
    for (;;) {
      resolve_doubt(stop);
      auto request = queue.next(stop);
      if (!request) break;
      ModbusReply reply = attempt(*request);
      if (reply.outcome == ModbusOutcome::kUnknown && --request->attempts_left > 0 && !stop.stop_requested()) {
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
    std::string why = "unknown exception";
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      why = error.what();
    } catch (...) {
    }
    spdlog::error("thread {} ended by an exception: {}", name, why);
    queue.close("the link has failed: " + why);
  }

  ModbusReply attempt(const QueuedRequest& request) {
    ModbusReply reply;
    if (!transport.connected()) {
      {
        const MutexLock lock(mutex);
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
  void resolve_doubt(const std::stop_token& stop) {
    if (!doubtful) return;
    doubtful = false;
    const std::size_t discarded = transport.resynchronise([&] { return stop.stop_requested() || queue.has_urgent(); });
    const MutexLock lock(mutex);
    statistics.discarded_bytes += discarded;
  }

  ModbusReply book(ModbusReply reply, SteadyClock::duration latency) {
    const MutexLock lock(mutex);
    ++statistics.transactions;
    if (reply.outcome == ModbusOutcome::kUnknown) ++statistics.unknown;
    if (reply.outcome == ModbusOutcome::kRejected) ++statistics.rejected;
    if (reply.outcome != ModbusOutcome::kUnknown) {
      latencies_us[latency_count++ % kLatencySamples] = std::chrono::duration<double, std::micro>(latency).count();
    }
    return reply;
  }

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

ModbusReply ModbusLink::read(ModbusTable table, int address, int count, ModbusPriority priority) {
  QueuedRequest request;
  request.what = {table, address, count, {}, false};
  request.attempts_left = kReadAttempts;
  return impl_->queue.submit(std::move(request), priority);
}

ModbusReply ModbusLink::write(ModbusTable table, int address, std::span<const std::uint16_t> values,
                              ModbusPriority priority, bool single) {
  QueuedRequest request;
  request.what = {table, address, 0, {values.begin(), values.end()}, single};
  return impl_->queue.submit(std::move(request), priority);
}

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

}  // namespace fvd
