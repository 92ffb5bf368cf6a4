#pragma once

/// The requests that wait for a Modbus line, each with somebody who waits for its answer.

#include <chrono>
#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "drivers/modbus/modbus_transport.hpp"

namespace fvd {

enum class ModbusOutcome {
  kOk,
  kRejected,  ///< the device answered with an exception: surely not executed, the link is fine
  kUnknown,   ///< no usable answer: may or may not have been executed
};

enum class ModbusPriority { kNormal, kUrgent };

struct ModbusReply {
  ModbusOutcome outcome = ModbusOutcome::kUnknown;
  std::string error;  ///< empty if kOk
  /// Of kUnknown: it was told to come again later, because the device is at it or busy. The line is sound.
  bool later = false;
  std::vector<std::uint16_t> values;  ///< of a read that is kOk
  /// Middle of the transaction that succeeded: the best guess of when the device sampled its registers.
  std::chrono::steady_clock::time_point sampled{};
};

/// A request on its way. One that is destroyed unanswered gives kUnknown to whoever waits.
struct QueuedRequest {
  ModbusRequest what;
  int attempts_left = 1;
  std::promise<ModbusReply> done;
};

/// Urgent requests go ahead of all others. context: thread-safe.
class ModbusQueue {
 public:
  /// Waits for the answer. kUnknown if the queue is or becomes closed.
  [[nodiscard]] ModbusReply submit(QueuedRequest request, ModbusPriority priority);
  /// The next one; nothing on a stop request.
  [[nodiscard]] std::optional<QueuedRequest> next(std::stop_token stop);
  /// For another attempt: ahead of all that are not urgent.
  void put_back(QueuedRequest request);
  [[nodiscard]] bool has_urgent() const;
  /// Answers everything that waits, and all that is submitted from now on, with kUnknown and this reason.
  void close(const std::string& reason);

 private:
  mutable Mutex mutex_;
  Condition arrived_;
  std::deque<QueuedRequest> urgent_ FVD_GUARDED_BY(mutex_);
  std::deque<QueuedRequest> normal_ FVD_GUARDED_BY(mutex_);
  std::optional<std::string> closed_ FVD_GUARDED_BY(mutex_);  // the reason
};

}  // namespace fvd
