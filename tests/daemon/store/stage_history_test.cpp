#include "daemon/store/stage_history.hpp"

#include <fstream>
#include <vector>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

StepLog scan_with_error(double error_um) {
  StepLog log(21);
  for (std::size_t i = 0; i < log.size(); ++i) {
    log[i].index = static_cast<int>(i);
    log[i].error_um = i % 2 == 0 ? error_um : -error_um;
    log[i].move_ms = 60.0;
  }
  return log;
}

class AStageHistory : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return scratch_ / "stage_history.json"; }
  test::ScratchDir scratch_;
};

TEST_F(AStageHistory, OutlivesTheDaemon) {
  {
    StageHistory history(file());
    EXPECT_FALSE(history.summary());
    history.add(FeedbackSource::kMotorEncoder, scan_with_error(0.02));
  }
  StageHistory again(file());
  again.add(FeedbackSource::kMotorEncoder, scan_with_error(0.04));
  const auto summary = again.summary();
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->scans, 2U);
  EXPECT_EQ(summary->steps, 42U);
  EXPECT_NEAR(*summary->error_max_um, 0.04, 1e-12);
  EXPECT_NEAR(*summary->move_p50_ms, 60.0, 1.4);
}

TEST_F(AStageHistory, StartsAnewForAnotherKindOfFeedback) {
  StageHistory history(file());
  history.add(FeedbackSource::kMotorEncoder, scan_with_error(0.02));
  history.add(FeedbackSource::kNone, scan_with_error(0.0));
  EXPECT_EQ(history.summary()->scans, 1U);
  EXPECT_FALSE(history.summary()->error_max_um) << "not observable, not zero";
  EXPECT_TRUE(std::filesystem::exists(file().string() + ".old"));
}

TEST_F(AStageHistory, MovesADamagedFileAside) {
  for (const char* text : {"", "{", "[]", R"({"version": 2})", R"({"version": 1, "feedback": "tape"})"}) {
    std::ofstream(file()) << text;
    StageHistory history(file());
    EXPECT_FALSE(history.summary()) << text;
    EXPECT_FALSE(std::filesystem::exists(file())) << text;
  }
}

TEST_F(AStageHistory, RemovesWhatAProcessLeftThatWasKilledWhileItWrote) {
  const std::vector<std::filesystem::path> left{scratch_ / "stage_history.json.tmp",
                                                scratch_ / ".stage_history.json.tmp"};
  for (const auto& part : left) std::ofstream(part) << "{";
  const StageHistory history(file());
  for (const auto& part : left) EXPECT_FALSE(std::filesystem::exists(part)) << part;
}

TEST(StepHistoryText, ReadsBackWhatItWrote) {
  StepHistory history(FeedbackSource::kLinearScale);
  history.add(scan_with_error(0.1));
  const StepHistoryState state = parse_step_history(step_history_json(history.state()));
  EXPECT_EQ(state.error_sizes.counts, history.state().error_sizes.counts);
  EXPECT_EQ(state.error.sum_of_squares, history.state().error.sum_of_squares);
  EXPECT_EQ(state.feedback, FeedbackSource::kLinearScale);
  std::string wrong = step_history_json(history.state());
  wrong.replace(wrong.find("\"error_sizes_um\":[["), 19, "\"error_sizes_um\":[[99");
  EXPECT_THROW((void)parse_step_history(wrong), Error);
}

}  // namespace
}  // namespace fvd
