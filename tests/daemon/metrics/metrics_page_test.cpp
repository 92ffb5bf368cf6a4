#include "daemon/metrics/metrics_page.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "core/runtime/thread_ticks.hpp"
#include "tests/daemon/surface_files/peak_memory.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Optional;

MachineStatus a_busy_station() {
  MachineStatus machine;
  machine.state = ScanState::kExecuting;
  machine.results_waiting = 3;
  machine.epoch = 17;
  machine.ended = {.completed = 5, .aborted = 1, .failed = 2, .interrupted = 4};
  machine.health.camera = {.open = true, .openings = 2};
  machine.health.stage = {.open = true, .openings = 1};
  machine.health.frames = {.frames_complete = 100, .frames_failed = 4, .packets_resent = 7};
  machine.health.link = StageLinkStats{.requests = 1000, .retries = 6, .latency_p50_us = 1500.0};
  for (int i = 0; i < 50; ++i) machine.health.temperatures.push_back({"sensor" + std::to_string(i), 40.0 + i});
  machine.disk = DiskSpace{1'000'000, 2'000'000};
  return machine;
}

TEST(MetricsPage, TellsStatesCountersAndUnits) {
  const std::string page = metrics_text(a_busy_station());
  for (const char* line :
       {"fvd_state{state=\"executing\"} 1\n", "fvd_state{state=\"ready\"} 0\n", "fvd_error_code 0\n",
        "fvd_jobs_total{outcome=\"completed\"} 5\n", "fvd_jobs_total{outcome=\"failed\"} 2\n",
        "fvd_jobs_total{outcome=\"interrupted\"} 4\n", "fvd_results_unacknowledged 3\n",
        "fvd_device_openings_total{device=\"camera\"} 2\n", "fvd_camera_frames_total{status=\"complete\"} 100\n",
        "fvd_camera_packets_total{kind=\"resent\"} 7\n", "fvd_stage_request_errors_total{kind=\"retried\"} 6\n",
        "fvd_stage_latency_seconds{quantile=\"0.5\"} 0.0015",
        "fvd_temperature_celsius{device=\"stage\",sensor=\"sensor0\"} 40\n", "fvd_storage_free_bytes 1000000\n",
        "# TYPE fvd_jobs_total counter\n", "# TYPE fvd_state gauge\n"}) {
    EXPECT_THAT(page, HasSubstr(line));
  }
}

TEST(MetricsPage, HasAFewSeriesWhateverIsMeasured) {
  MachineStatus machine = a_busy_station();
  JobStatus job;
  job.job_id = "job-1234";
  job.request.seq = 9;
  job.request.part_id = "part-77";
  job.request.client = "line-3";
  machine.job = job;
  const std::string page = metrics_text(machine);
  std::istringstream lines(page);
  int series = 0;
  for (std::string line; std::getline(lines, line);) series += line.empty() || line.front() == '#' ? 0 : 1;
  EXPECT_LE(series, 200);
  for (const char* of_one_job : {"job-1234", "part-77", "line-3"}) EXPECT_THAT(page, Not(HasSubstr(of_one_job)));
}

TEST(MetricsPage, HasEverySeriesFromTheStart) {
  const std::string page = metrics_text(MachineStatus{});
  for (const char* line : {"fvd_jobs_total{outcome=\"failed\"} 0\n", "fvd_camera_frames_total{status=\"failed\"} 0\n",
                           "fvd_device_open{device=\"stage\"} 0\n", "fvd_state{state=\"preoperational\"} 1\n"}) {
    EXPECT_THAT(page, HasSubstr(line));
  }
}

TEST(MetricsPage, IsHealthyWhileItCanMeasureOrDoes) {
  MachineStatus machine;
  for (const ScanState good : {ScanState::kInitialized, ScanState::kReady, ScanState::kExecuting}) {
    machine.state = good;
    EXPECT_EQ(why_unhealthy(machine), std::nullopt);
  }
  machine.state = ScanState::kError;
  machine.error = ErrorCode::kStageDisconnected;
  machine.error_message = "the drive does not answer";
  EXPECT_THAT(why_unhealthy(machine), Optional(std::string("error: the drive does not answer")));
  machine.state = ScanState::kPreoperational;
  EXPECT_TRUE(why_unhealthy(machine).has_value());
}

TEST(MetricsPage, IsUnhealthyWhileAThreadHangs) {
  MachineStatus machine;
  machine.state = ScanState::kReady;
  ThreadTicks ticks("fvd-example", std::chrono::milliseconds(1));
  ticks.tick(HostClock::now() - std::chrono::seconds(1));
  EXPECT_THAT(why_unhealthy(machine), Optional(HasSubstr("fvd-example hangs")));
  EXPECT_THAT(metrics_text(machine), HasSubstr("fvd_threads_stalled 1\n"));
}

/// Of a series without labels; -1 = there is none.
double value_of(const std::string& page, const std::string& series) {
  const auto at = page.find("\n" + series + " ");
  return at == std::string::npos ? -1.0 : std::strtod(page.c_str() + at + series.size() + 2, nullptr);
}

TEST(MetricsPage, TellsOfTheHeapWhatIsInUseAndWhatIsHeld) {
  const std::string page = metrics_text(MachineStatus{});
  const double in_use_bytes = value_of(page, "fvd_heap_in_use_bytes");
  const double held_bytes = value_of(page, "fvd_heap_held_bytes");
  EXPECT_GE(in_use_bytes, test::kKeepsWhatIsFreed ? 0.0 : 1.0) << "a sanitizer has a heap of its own";
  EXPECT_GE(held_bytes, in_use_bytes);
}

std::string promtool() { return std::getenv("FVD_PROMTOOL") != nullptr ? std::getenv("FVD_PROMTOOL") : "promtool"; }

bool has_promtool() {
  test::ChildProcess tool({promtool(), "--version"});
  (void)tool.rest();
  return tool.wait() == 0;
}

TEST(MetricsPage, PleasesPromtool) {
  if (!has_promtool()) GTEST_SKIP() << "promtool (Debian: prometheus) is not installed";
  const test::ScratchDir folder;
  test::write_text(folder.path() / "page", metrics_text(a_busy_station()));
  test::ChildProcess tool({"sh", "-c", promtool() + " check metrics < " + (folder.path() / "page").string()});
  const std::string says = tool.rest();
  EXPECT_EQ(tool.wait(), 0) << says;
}

TEST(AlertRules, PleasePromtool) {
  if (!has_promtool()) GTEST_SKIP() << "promtool (Debian: prometheus) is not installed";
  test::ChildProcess tool({promtool(), "check", "rules", FVD_SOURCE_DIR "/systemd/fvd-alerts.yml"});
  const std::string says = tool.rest();
  EXPECT_EQ(tool.wait(), 0) << says;
}

TEST(AlertRules, NameOnlySeriesThatThereAre) {
  const std::string page = metrics_text(a_busy_station());
  const std::string rules = test::read_text(FVD_SOURCE_DIR "/systemd/fvd-alerts.yml");
  const std::regex name("\\bfvd_[a-z_]+");
  std::set<std::string> names;
  for (std::sregex_iterator at(rules.begin(), rules.end(), name), end; at != end; ++at) names.insert(at->str());
  EXPECT_GE(names.size(), 5U);
  for (const std::string& series : names) EXPECT_THAT(page, HasSubstr("# TYPE " + series + " "));
}

}  // namespace
}  // namespace fvd
