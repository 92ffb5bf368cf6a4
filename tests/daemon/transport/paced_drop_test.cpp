/// At what pace is dropped what a refused client goes on sending, by a timer that comes when the test says so.

#include "daemon/transport/paced_drop.hpp"

#include <functional>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <gtest/gtest.h>

namespace fvd {
namespace {

class HandTimer {
 public:
  void expires_after(std::chrono::milliseconds time) { asked_ = time; }
  template <typename Handler>
  void async_wait(Handler handler) {
    handler_ = std::move(handler);
  }
  void come(boost::system::error_code why = {}) { std::exchange(handler_, {})(why); }

  [[nodiscard]] std::chrono::milliseconds asked() const { return asked_; }
  [[nodiscard]] bool is_awaited() const { return handler_ != nullptr; }

 private:
  std::chrono::milliseconds asked_{};
  std::function<void(boost::system::error_code)> handler_;
};

class AFloodThatIsDropped : public testing::Test {
 protected:
  AFloodThatIsDropped() {
    boost::asio::local::connect_pair(client_, server_);
    client_.non_blocking(true);
    drop_at_a_pace(server_, pause_, [this] { is_done_ = true; });
  }
  /// As much as the buffers between the two take.
  void flood() {
    const std::string piece(4096, 'x');
    boost::system::error_code full;
    while (!full) client_.write_some(boost::asio::buffer(piece), full);
  }
  void work() {
    context_.restart();
    context_.poll();
  }

  boost::asio::io_context context_;
  boost::asio::local::stream_protocol::socket client_{context_};
  boost::asio::local::stream_protocol::socket server_{context_};
  HandTimer pause_;
  bool is_done_ = false;
};

TEST_F(AFloodThatIsDropped, IsReadOnceEachTimeThePauseIsOver) {
  for (int i = 0; i < 3; ++i) {
    flood();
    const std::size_t before = server_.available();
    ASSERT_GT(before, kDropChunk_bytes) << "or nothing is shown";
    work();
    EXPECT_EQ(server_.available(), before) << "nothing within the pause";
    EXPECT_EQ(pause_.asked(), kDropPause);
    ASSERT_TRUE(pause_.is_awaited());
    pause_.come();
    work();
    EXPECT_EQ(before - server_.available(), kDropChunk_bytes);
  }
  EXPECT_FALSE(is_done_);
}

TEST_F(AFloodThatIsDropped, EndsWithTheClient) {
  client_.close();
  pause_.come();
  EXPECT_FALSE(is_done_) << "nobody is called from within";
  work();
  EXPECT_TRUE(is_done_);
  EXPECT_FALSE(pause_.is_awaited());
}

TEST_F(AFloodThatIsDropped, IsLeftAloneOnceTheTimerIsCancelled) {
  flood();
  const std::size_t before = server_.available();
  pause_.come(boost::asio::error::operation_aborted);
  work();
  EXPECT_EQ(server_.available(), before);
  EXPECT_FALSE(is_done_);
  EXPECT_FALSE(pause_.is_awaited());
}

}  // namespace
}  // namespace fvd
