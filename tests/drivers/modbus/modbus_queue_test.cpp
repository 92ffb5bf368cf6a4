/// Every request is answered, whatever becomes of the thread that serves the line.

#include "drivers/modbus/modbus_queue.hpp"

#include <future>
#include <thread>

#include "gtest/gtest.h"

namespace fvd {
namespace {

QueuedRequest request_to(int address) {
  QueuedRequest request;
  request.what.address = address;
  return request;
}

std::future<ModbusReply> submitted(ModbusQueue& queue, int address, ModbusPriority priority = ModbusPriority::kNormal) {
  return std::async(std::launch::async,
                    [&queue, address, priority] { return queue.submit(request_to(address), priority); });
}

TEST(ModbusQueue, GivesUrgentRequestsFirst) {
  ModbusQueue queue;
  auto normal = submitted(queue, 1);
  auto first = queue.next({});
  ASSERT_TRUE(first);
  queue.put_back(std::move(*first));
  auto urgent = submitted(queue, 2, ModbusPriority::kUrgent);
  while (!queue.has_urgent()) std::this_thread::yield();
  for (const int address : {2, 1}) {
    auto next = queue.next({});
    ASSERT_TRUE(next);
    EXPECT_EQ(next->what.address, address);
    next->done.set_value({ModbusOutcome::kOk, "", {}, {}});
  }
  EXPECT_EQ(normal.get().outcome, ModbusOutcome::kOk);
  EXPECT_EQ(urgent.get().outcome, ModbusOutcome::kOk);
}

TEST(ModbusQueue, AnswersEverybodyWhoWaitsWhenItIsClosed) {
  ModbusQueue queue;
  std::vector<std::future<ModbusReply>> waiting;
  for (int i = 0; i < 8; ++i) {
    waiting.push_back(submitted(queue, i, i % 2 == 0 ? ModbusPriority::kNormal : ModbusPriority::kUrgent));
  }
  queue.close("the cable burned");
  for (auto& reply : waiting) {
    const ModbusReply got = reply.get();
    EXPECT_EQ(got.outcome, ModbusOutcome::kUnknown);
    EXPECT_EQ(got.error, "the cable burned");
  }
  EXPECT_EQ(queue.submit(request_to(9), ModbusPriority::kUrgent).error, "the cable burned");
}

TEST(ModbusQueue, AnswersARequestThatItsServerDropped) {
  ModbusQueue queue;
  auto waiting = submitted(queue, 1);
  { EXPECT_TRUE(queue.next({})); }
  EXPECT_EQ(waiting.get().outcome, ModbusOutcome::kUnknown);
}

TEST(ModbusQueue, AnswersARequestThatIsPutBackOnceItIsClosed) {
  ModbusQueue queue;
  auto waiting = submitted(queue, 1);
  auto request = queue.next({});
  ASSERT_TRUE(request);
  queue.close("over");
  queue.put_back(std::move(*request));
  EXPECT_EQ(waiting.get().error, "over");
}

TEST(ModbusQueue, EndsAServersWaitOnAStopRequest) {
  ModbusQueue queue;
  std::stop_source stop;
  auto server = std::async(std::launch::async, [&] { return queue.next(stop.get_token()).has_value(); });
  stop.request_stop();
  EXPECT_FALSE(server.get());
}

}  // namespace
}  // namespace fvd
