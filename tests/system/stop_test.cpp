/// Stops and jogs through the real protocol stacks. The figures are logged; the bounds here only tell a stop from none.

#include <algorithm>
#include <vector>

#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr std::chrono::seconds kPatience{10};

class AMovingMicroscope : public AMicroscope {
 protected:
  bool await_motion(bool wanted) {
    const auto deadline = HostClock::now() + kPatience;
    while (plant_->axis().moving(HostClock::now()) != wanted) {
      if (HostClock::now() > deadline) return false;
      std::this_thread::yield();
    }
    return true;
  }
  static double ms(HostClock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); }
};

TEST_F(AMovingMicroscope, StopsAMoveWithoutControl) {
  start();
  ask("stage.home", json::object());
  std::vector<double> replies_ms;
  std::vector<double> rests_ms;
  for (int i = 0; i < 5; ++i) {
    const double target_um = i % 2 == 0 ? 450.0 : -450.0;
    LineClient mover(app_->rpc_port());
    mover.send(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "stage.move"}, {"params", {{"z_um", target_um}}}}.dump() +
               "\n");
    ASSERT_TRUE(await_motion(true));
    // On the same connection, behind the move that is still unanswered.
    const HostTime asked = HostClock::now();
    mover.send(json{{"jsonrpc", "2.0"}, {"id", 2}, {"method", "stage.stop"}}.dump() + "\n");
    const auto stopped = mover.line(kPatience);
    ASSERT_TRUE(stopped);
    replies_ms.push_back(ms(HostClock::now() - asked));
    EXPECT_EQ(json::parse(*stopped)["id"], 2) << *stopped;
    EXPECT_EQ(json::parse(*stopped)["result"]["stopped"], "command") << *stopped;
    ASSERT_TRUE(await_motion(false));
    rests_ms.push_back(ms(HostClock::now() - asked));
    const auto moved = mover.line(kPatience);
    ASSERT_TRUE(moved);
    EXPECT_EQ(json::parse(*moved)["error"]["data"]["error"], "aborted") << *moved;
    EXPECT_GT(std::abs(plant_->axis().true_position_um(HostClock::now()) - target_um), 1.0);
  }
  const auto most = [](const std::vector<double>& times) { return *std::max_element(times.begin(), times.end()); };
  std::printf("stage.stop: answered within %.1f ms, at rest within %.1f ms\n", most(replies_ms), most(rests_ms));
  RecordProperty("stop_reply_ms", std::to_string(most(replies_ms)));
  RecordProperty("stop_rest_ms", std::to_string(most(rests_ms)));
}

TEST_F(AMovingMicroscope, JogsWhileItIsRepeatedAndHaltsByItself) {
  start();
  ask("stage.home", json::object());
  LineClient client(app_->rpc_port());
  const std::string jog = json{{"jsonrpc", "2.0"},
                               {"id", 1},
                               {"method", "stage.jog"},
                               {"params", {{"direction", "up"}, {"speed_um_per_s", 100}, {"until_ms", 150}}}}
                              .dump();
  HostTime last{};
  const auto deadline = HostClock::now() + kPatience;
  bool moved = false;
  for (int repeats = 0; repeats < 8 || !moved; ++repeats) {
    last = HostClock::now();
    const json answer = json::parse(client.ask(jog));
    // A busy machine may let a jog run out between two repeats: the next one begins a new one, or finds it ending.
    EXPECT_TRUE(answer.contains("result") || answer["error"]["code"] == 1002) << answer;
    ASSERT_LT(HostClock::now(), deadline) << "the axis does not move";
    moved = moved || plant_->axis().moving(HostClock::now());
    SystemClock().wait_until(last + milliseconds(40), {});  // as a key that is held repeats
  }
  ASSERT_TRUE(await_motion(false));
  const double after_ms = ms(HostClock::now() - last);
  std::printf("stage.jog: at rest %.1f ms after the last repeat\n", after_ms);
  RecordProperty("jog_rest_ms", std::to_string(after_ms));
  EXPECT_LT(after_ms, 5000.0);
  const double here_um = plant_->axis().true_position_um(HostClock::now());
  EXPECT_LT(here_um, 499.0) << "far from the limit";
  EXPECT_TRUE(wait_until_ready());
}

}  // namespace
}  // namespace fvd
