#include "drivers/modbus/modbus_link.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sys/socket.h>

#include "core/error.hpp"

namespace fvd {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int kReadAttempts = 3;
constexpr std::size_t kLatencySamples = 1024;

struct ContextDeleter {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using Context = std::unique_ptr<modbus_t, ContextDeleter>;

struct Request {
  int address = 0;
  int read_count = 0;                  // > 0: a read
  std::vector<std::uint16_t> written;  // else a write
  int attempts_left = 1;
  std::promise<ModbusReply> done;
};

bool is_exception(int error) { return error > MODBUS_ENOBASE && error <= EMBXGTAR; }

}  // namespace

struct ModbusLink::Impl {
  explicit Impl(const ModbusLinkConfig& c) : config(c) {
    const std::string port = std::to_string(config.port);
    context.reset(modbus_new_tcp_pi(config.host.c_str(), port.c_str()));
    if (!context)
      throw Error(ErrorCode::kStageDisconnected,
                  "no Modbus connection to " + describe() + ": " + modbus_strerror(errno));
    modbus_set_error_recovery(context.get(), MODBUS_ERROR_RECOVERY_NONE);
    const auto timeout = std::chrono::duration_cast<std::chrono::microseconds>(config.response_timeout).count();
    const auto seconds = static_cast<std::uint32_t>(timeout / 1000000);
    const auto microseconds = static_cast<std::uint32_t>(timeout % 1000000);
    modbus_set_response_timeout(context.get(), seconds, microseconds);
    // 0 = the whole reply within the response timeout: a trickle of bytes cannot stretch it.
    modbus_set_byte_timeout(context.get(), 0, 0);
    if (modbus_set_slave(context.get(), config.unit) != 0 || !connect()) {
      throw Error(ErrorCode::kStageDisconnected, "no Modbus connection to " + describe() + ": " +
                                                     modbus_strerror(errno) +
                                                     "; is the drive switched on and its address right?");
    }
    thread = std::jthread([this](std::stop_token stop) { run(stop); });
    pthread_setname_np(thread.native_handle(), "fvd-modbus");
  }

  [[nodiscard]] std::string describe() const {
    return config.host + ":" + std::to_string(config.port) + " unit " + std::to_string(config.unit);
  }

  bool connect() {
    connected = modbus_connect(context.get()) == 0;
    if (connected) {
      const int on = 1;
      ::setsockopt(modbus_get_socket(context.get()), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    }
    return connected;
  }

  void disconnect() {
    modbus_close(context.get());
    connected = false;
  }

  void run(std::stop_token stop) {
    while (auto request = next(stop)) {
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

  ModbusReply attempt(Request& request) {
    ModbusReply reply;
    if (!connected) {
      {
        const std::lock_guard lock(mutex);
        ++statistics.reconnects;
      }
      if (!connect()) {
        reply.error = std::string("cannot connect: ") + modbus_strerror(errno);
        return book(std::move(reply), SteadyClock::duration::zero());
      }
    }
    const auto begin = SteadyClock::now();
    const int expected = request.read_count > 0 ? request.read_count : static_cast<int>(request.written.size());
    int count = 0;
    if (request.read_count > 0) {
      reply.values.resize(static_cast<std::size_t>(request.read_count));
      count = modbus_read_registers(context.get(), request.address, request.read_count, reply.values.data());
    } else {
      count = modbus_write_registers(context.get(), request.address, expected, request.written.data());
    }
    const int error = errno;
    const auto end = SteadyClock::now();
    reply.sampled = begin + (end - begin) / 2;
    if (count == expected) {
      reply.outcome = ModbusOutcome::kOk;
    } else {
      reply.values.clear();
      reply.error = modbus_strerror(error);
      if (count == -1 && (is_exception(error) || error == EMBBADEXC)) {
        reply.outcome = ModbusOutcome::kRejected;
      } else {
        disconnect();  // a late reply must never meet the next request
      }
    }
    return book(std::move(reply), end - begin);
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

  const ModbusLinkConfig config;
  Context context;         // I/O thread only, once it runs
  bool connected = false;  // likewise
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

ModbusReply ModbusLink::read(int address, int count, ModbusPriority priority) {
  Request request;
  request.address = address;
  request.read_count = count;
  request.attempts_left = kReadAttempts;
  return impl_->submit(std::move(request), priority);
}

ModbusReply ModbusLink::write(int address, std::span<const std::uint16_t> values, ModbusPriority priority) {
  Request request;
  request.address = address;
  request.written.assign(values.begin(), values.end());
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

std::string ModbusLink::description() const { return impl_->describe(); }

}  // namespace fvd
