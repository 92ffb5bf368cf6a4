#include "drivers/modbus/modbus_queue.hpp"

#include <utility>

namespace fvd {

namespace {

ModbusReply unknown(const std::string& why) {
  ModbusReply reply;
  reply.error = why;
  return reply;
}

}  // namespace

ModbusReply ModbusQueue::submit(QueuedRequest request, ModbusPriority priority) {
  auto reply = request.done.get_future();
  {
    const MutexLock lock(mutex_);
    if (closed_) return unknown(*closed_);
    (priority == ModbusPriority::kUrgent ? urgent_ : normal_).push_back(std::move(request));
  }
  arrived_.notify_one();
  try {
    return reply.get();
  } catch (const std::future_error&) {
    return unknown("the request was dropped");
  }
}

std::optional<QueuedRequest> ModbusQueue::next(std::stop_token stop) {
  MutexLock lock(mutex_);
  const bool some = arrived_.wait(lock, stop, [this] {
    mutex_.assert_held();
    return !urgent_.empty() || !normal_.empty();
  });
  if (!some || stop.stop_requested()) return std::nullopt;
  auto& queue = urgent_.empty() ? normal_ : urgent_;
  QueuedRequest request = std::move(queue.front());
  queue.pop_front();
  return request;
}

void ModbusQueue::put_back(QueuedRequest request) {
  const MutexLock lock(mutex_);
  if (closed_) {
    request.done.set_value(unknown(*closed_));
  } else {
    normal_.push_front(std::move(request));
  }
}

bool ModbusQueue::has_urgent() const {
  const MutexLock lock(mutex_);
  return !urgent_.empty();
}

void ModbusQueue::close(const std::string& reason) {
  const MutexLock lock(mutex_);
  if (!closed_) closed_ = reason;
  for (auto* queue : {&urgent_, &normal_}) {
    for (QueuedRequest& request : *queue) request.done.set_value(unknown(reason));
    queue->clear();
  }
}

}  // namespace fvd
