/// The objective on the microscope: confirmed, kept, and what it lets jobs and commands do.

#include <cerrno>
#include <future>

#include <gmock/gmock.h>

#include "daemon/jobs/device_commands.hpp"
#include "daemon/jobs/objective_book.hpp"
#include "daemon/jobs/objective_limits.hpp"
#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/daemon/store/broken_disk.hpp"
#include "tests/daemon/store/held_disk.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kFor50x =
    R"({"format": 2, "acquire": {"objective": "50x", "scan": {"start_um": 0, "step_um": 10, "slices": 5}}})";

class AnObjective : public test::AnEngine {
 protected:
  AnObjective() {
    config_.objectives = {{"20x", 0.4, 20.0, 11.0}, {"50x", 0.55, 50.0, 3.1, -30.0, 45.0}};
    test::write_text(folder_.path() / "for_50x.json", kFor50x);
  }
  void open_devices() {
    open();
    ASSERT_TRUE(await_state(ScanState::kInitialized));
  }
  void restart() {
    TearDown();
    engine_.reset();
    store_.reset();
    store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");
    open_devices();
  }
  [[nodiscard]] ObjectiveService& objectives() { return services_->objectives; }
  /// The answer to a command of the stage.
  [[nodiscard]] DeviceTask::Outcome answer(DeviceTask::Work work) {
    const auto task = tasks().submit(std::move(work), TaskMotion::kMoves);
    EXPECT_TRUE(await_answer(*task));
    return task->outcome().value_or(DeviceTask::Outcome{});
  }
};

TEST_F(AnObjective, IsUnknownUntilSomebodyConfirmsIt) {
  open_devices();

  EXPECT_EQ(objectives().known().objectives.size(), 2U);
  EXPECT_FALSE(objectives().known().confirmed.has_value());
  EXPECT_EQ(machine().snapshot()->objective, "");
  FVD_EXPECT_ERROR_SAYING(
      kObjectiveMismatch, jobs().start({1, "a", "for_50x"}),
      AllOf(HasSubstr("'50x'"), HasSubstr("nobody has confirmed"), HasSubstr("fvdctl objective confirm")));
  FVD_EXPECT_ERROR(kObjectiveMismatch, jobs().prepare("for_50x"));
  EXPECT_FALSE(store_->highest("plc").has_value()) << "a job that was refused has no row";

  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate) << "a recipe that names none";
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AnObjective, LetsItsRecipesRunOnceItIsConfirmed) {
  open_devices();

  const ObjectiveConfirmation confirmed = objectives().confirm("50x", "Anna");

  EXPECT_EQ(confirmed.objective, "50x");
  EXPECT_EQ(confirmed.person, "Anna");
  EXPECT_THAT(confirmed.confirmed_utc, ::testing::MatchesRegex("20..-..-..T..:..:..\\....Z"));
  EXPECT_EQ(machine().snapshot()->objective, "50x");
  jobs().prepare("for_50x");
  EXPECT_FALSE(jobs().start({1, "a", ""}).duplicate);
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AnObjective, RefusesTheRecipesOfAnother) {
  open_devices();
  objectives().confirm("50x", "Anna");
  jobs().prepare("for_50x");

  objectives().confirm("20x", "Bert");

  FVD_EXPECT_ERROR_SAYING(kObjectiveMismatch, jobs().start({1, "a", ""}),
                          AllOf(HasSubstr("'50x'"), HasSubstr("'20x' is the one that was confirmed")));
  EXPECT_EQ(objectives().known().confirmed->person, "Bert");
}

TEST_F(AnObjective, StaysConfirmedOverARestart) {
  open_devices();
  objectives().confirm("20x", "Anna");
  objectives().confirm("50x", "Bert");

  restart();

  EXPECT_EQ(machine().snapshot()->objective, "50x");
  EXPECT_EQ(objectives().known().confirmed->person, "Bert");
  EXPECT_FALSE(jobs().start({1, "a", "for_50x"}).duplicate);
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AnObjective, IsForgottenWhereTheConfigurationNamesItNoMore) {
  open_devices();
  objectives().confirm("50x", "Anna");
  config_.objectives.pop_back();

  restart();

  EXPECT_EQ(machine().snapshot()->objective, "");
  EXPECT_FALSE(objectives().known().confirmed.has_value());
  FVD_EXPECT_ERROR_SAYING(kObjectiveMismatch, jobs().start({1, "a", "for_50x"}), HasSubstr("expected one of '20x'"));
}

TEST_F(AnObjective, IsNobodysConcernWhereNoneIsConfigured) {
  config_.objectives.clear();
  open_devices();

  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)objectives().confirm("50x", "Anna"), HasSubstr("names none"));
  FVD_EXPECT_ERROR_SAYING(kObjectiveMismatch, jobs().start({1, "a", "for_50x"}), HasSubstr("names none"));
  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate);
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AnObjective, IsRefusedUnderANameThatNoneHas) {
  open_devices();
  for (const char* name : {"", "50X", "50x ", "5Ox"}) {
    FVD_EXPECT_ERROR_SAYING(kBadInput, (void)objectives().confirm(name, "Anna"), HasSubstr("expected one of"));
  }
  EXPECT_FALSE(store_->objectives().latest().has_value());
}

TEST_F(AnObjective, CannotBeAnotherWhileAJobOrACommandRuns) {
  open_devices();
  objectives().confirm("20x", "Anna");
  test::Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  FVD_EXPECT_ERROR(kBusy, (void)objectives().confirm("50x", "Anna"));  // a command has the camera
  jobs().start({1, "a", "part"});                                      // waits behind it
  FVD_EXPECT_ERROR_SAYING(kBusy, (void)objectives().confirm("50x", "Anna"), HasSubstr("a job is accepted or runs"));
  hold.go.set_value();
  ASSERT_TRUE(await_end_of(1));

  EXPECT_EQ(machine().snapshot()->objective, "20x");
  EXPECT_EQ(objectives().confirm("50x", "Anna").objective, "50x");
}

TEST_F(AnObjective, LetsNothingBeginWhileItIsMadeDurable) {
  open_devices();
  objectives().confirm("20x", "Anna");
  test::HeldDisk disk;
  auto confirming = std::async(std::launch::async, [this] { return objectives().confirm("50x", "Bert"); });
  disk.await_a_write();

  FVD_EXPECT_ERROR(kBusy, jobs().start({1, "a", "part"}));
  FVD_EXPECT_ERROR(kBusy, (void)tasks().submit(move_work(Micrometers{1.0}), TaskMotion::kMoves));
  FVD_EXPECT_ERROR(kBusy, (void)objectives().confirm("20x", "Anna"));
  EXPECT_EQ(machine().snapshot()->objective, "20x") << "told once it is on the disk";

  disk.let_go();
  EXPECT_EQ(confirming.get().person, "Bert");
  EXPECT_EQ(machine().snapshot()->objective, "50x");
  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate);
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AnObjective, StaysTheOldOneWhereTheDiskTakesNoOther) {
  open_devices();
  objectives().confirm("20x", "Anna");
  {
    const test::BrokenDisk full(ENOSPC, 0);
    FVD_EXPECT_ERROR(kStorageFull, (void)objectives().confirm("50x", "Bert"));
  }

  EXPECT_EQ(machine().snapshot()->objective, "20x");
  EXPECT_EQ(objectives().known().confirmed->objective, "20x");
  EXPECT_EQ(objectives().confirm("50x", "Bert").objective, "50x") << "nothing is left locked";
}

TEST_F(AnObjective, KeepsJobsToItsSoftLimits) {
  test::write_text(folder_.path() / "high.json", R"({"scan": {"start_um": 0, "step_um": 10, "slices": 6}})");
  test::write_text(folder_.path() / "low.json", R"({"scan": {"start_um": -11, "step_um": 10, "slices": 3}})");
  open_devices();
  objectives().confirm("50x", "Anna");

  FVD_EXPECT_ERROR_SAYING(kStageLimit, jobs().start({1, "a", "high"}),
                          AllOf(HasSubstr("objective '50x'"), HasSubstr("-30..45")));
  FVD_EXPECT_ERROR_SAYING(kStageLimit, jobs().prepare("low"), HasSubstr("objective '50x'"));
  objectives().confirm("20x", "Anna");
  jobs().prepare("low");
  EXPECT_FALSE(jobs().start({1, "a", "high"}).duplicate) << "the other has the stage's limits";
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AnObjective, KeepsMovesToItsSoftLimits) {
  open_devices();
  EXPECT_FALSE(answer(move_work(Micrometers{400.0})).error) << "none is confirmed: the stage's own limits hold";
  objectives().confirm("50x", "Anna");

  for (const double outside_um : {45.001, -30.001, 400.0}) {
    const DeviceTask::Outcome outcome = answer(move_work(Micrometers{outside_um}));
    EXPECT_EQ(outcome.error, ErrorCode::kStageLimit) << outside_um;
    EXPECT_THAT(outcome.message, AllOf(HasSubstr("objective '50x'"), HasSubstr("nothing was moved")));
  }
  EXPECT_FALSE(answer(move_work(Micrometers{45.0})).error);
  EXPECT_FALSE(answer(move_work(Micrometers{-30.0})).error);
  EXPECT_THAT(answer(move_work(Micrometers{501.0})).message, ::testing::Not(HasSubstr("objective")))
      << "outside the stage's limits it is the stage that refuses";
}

TEST_F(AnObjective, KeepsTheAutofocusToItsSoftLimits) {
  open_devices();
  objectives().confirm("50x", "Anna");
  AutofocusPlan plan;
  plan.from = Micrometers{0.0};
  plan.to = Micrometers{46.0};

  const DeviceTask::Outcome outcome = answer(autofocus_work(CameraSettings{}, plan));

  EXPECT_EQ(outcome.error, ErrorCode::kStageLimit);
  EXPECT_THAT(outcome.message, HasSubstr("objective '50x'"));
  plan.to = Micrometers{45.0};
  plan.from = Micrometers{-11.0};
  EXPECT_EQ(answer(autofocus_work(CameraSettings{}, plan)).error, ErrorCode::kStageLimit) << "with its take-up of 20";
  plan.from = Micrometers{-10.0};
  EXPECT_NE(answer(autofocus_work(CameraSettings{}, plan)).error, ErrorCode::kStageLimit);
}

TEST_F(AnObjective, StandsInTheResultBesideTheTemperature) {
  config_.temperature.file = folder_.path() / "absent";
  std::vector<ResultData> results;
  open([&results](AtomicDirectory&, const ResultData& data, FirstFilesWriter*) {
    results.emplace_back();
    results.back().objective = data.objective;
    results.back().temperature = data.temperature;
    results.back().warnings = data.warnings;
    return JobResult{};
  });
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  objectives().confirm("20x", "Anna");

  JobRequest warm{1, "a", "part"};
  warm.temperature_c = 21.5;
  jobs().start(warm);
  ASSERT_TRUE(await_end_of(1));
  jobs().start({2, "a", "part"});
  ASSERT_TRUE(await_end_of(2));

  const auto unknown = [](const ResultData& result) {
    return std::count_if(result.warnings.begin(), result.warnings.end(),
                         [](const Warning& warning) { return warning.code == "temperature_unknown"; });
  };
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].objective, "20x");
  EXPECT_EQ(results[0].temperature, (Temperature{21.5, "job", 0.0}));
  EXPECT_EQ(unknown(results[0]), 0);
  EXPECT_FALSE(results[1].temperature.has_value());
  EXPECT_EQ(unknown(results[1]), 1);
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kCompleted) << "a temperature ends no job";
}

TEST_F(AnObjective, IsTheSameInAllScansOfAJob) {
  test::write_text(folder_.path() / "thrice.json",
                   R"({"format": 2, "acquire": {"repeat": 3, "scan": {"start_um": 0, "step_um": 10, "slices": 5}}})");
  open_devices();

  const JobStatus started = jobs().start({1, "a", "thrice"}).job;

  EXPECT_EQ(started.slices_planned, 15);
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->job->slices_done, 15);
  EXPECT_EQ(machine().snapshot()->job->frames.ok, 15U);
  EXPECT_EQ(services_->tasks.stage_history()->scans, 3U) << "the stage is learnt from every scan";
}

TEST(ObjectiveLimits, NarrowTheStagesAndNeverWidenThem) {
  StageInfo stage;
  stage.min = Micrometers{-100.0};
  stage.max = Micrometers{100.0};

  const StageInfo narrow = limited_by({"a", 0.4, 20.0, 11.0, -50.0, std::nullopt}, stage);
  const StageInfo wide = limited_by({"a", 0.4, 20.0, 11.0, -500.0, 500.0}, stage);

  EXPECT_EQ(narrow.min, Micrometers{-50.0});
  EXPECT_EQ(narrow.max, Micrometers{100.0});
  EXPECT_EQ(wide.min, stage.min);
  EXPECT_EQ(wide.max, stage.max);
}

}  // namespace
}  // namespace fvd
