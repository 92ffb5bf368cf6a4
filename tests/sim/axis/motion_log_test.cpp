#include "sim/axis/motion_log.hpp"

#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct AMotionLog : testing::Test {
  /// The lines without their times.
  std::vector<std::string> words() const {
    std::ifstream in(file_);
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) {
      std::istringstream parts(line);
      long long ns = 0;
      parts >> ns >> std::ws;
      std::string rest;
      std::getline(parts, rest);
      EXPECT_GT(ns, 0);
      all.push_back(rest);
    }
    return all;
  }
  void await(const std::string& last) const {
    const auto deadline = HostClock::now() + std::chrono::seconds(30);
    while (HostClock::now() < deadline && (words().empty() || words().back() != last)) std::this_thread::yield();
  }

  test::ScratchDir folder_;
  std::filesystem::path file_ = folder_.path() / "motion.txt";
  AxisModel axis_{{}};
};

TEST_F(AMotionLog, HasCommandsAndMotions) {
  const MotionLog log(axis_, file_);
  axis_.home(HostClock::now());
  await("still");
  axis_.move_to(HostClock::now(), 2050, 1e5, 2e6, 2e6);
  await("still");
  axis_.stop(HostClock::now());
  EXPECT_THAT(words(), ElementsAre("home", "moving", "still", "move 20.500000", "moving", "still", "stop"));
}

TEST_F(AMotionLog, SaysThatItCannotBeWritten) {
  try {
    const MotionLog log(axis_, folder_.path() / "nowhere" / "motion.txt");
    FAIL() << "made";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kStorageWrite);
    EXPECT_THAT(error.what(), HasSubstr("nowhere/motion.txt"));
  }
}

}  // namespace
}  // namespace fvd::sim
