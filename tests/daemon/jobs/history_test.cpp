/// What a machine's jobs leave in the lists: in the same commit as their ends, or not at all.

#include <gmock/gmock.h>

#include "daemon/export/file_calls.hpp"
#include "daemon/jobs/reconcile_results.hpp"
#include "tests/daemon/jobs/engine_bench.hpp"

namespace fvd {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kSa = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.5}},
  "evaluation": {"measurements": {"texture": {"kind": "areal", "parameters": ["Sa"],
                                              "limits": {"Sa_um": {"upper": 0.8}}}}}})";

class AHistoryOfAMachine : public test::AnEngine {
 protected:
  void SetUp() override {
    test::write_text(folder_.path() / "texture.json", kSa);
    open();
    ASSERT_TRUE(await_state(ScanState::kInitialized));
  }
  std::string measure(std::int64_t seq, const std::string& recipe) {
    const std::string id = jobs().start({seq, "part-" + std::to_string(seq), recipe}).job.job_id;
    EXPECT_TRUE(await_end_of(seq));
    return id;
  }
  [[nodiscard]] const HistoryService& history() { return services_->history; }
};

TEST_F(AHistoryOfAMachine, HasEachJobAndItsValuesAsSoonAsItsEndIsTold) {
  const std::string first = measure(1, "texture");
  const std::string second = measure(2, "part");

  const JobPage page = history().list({}, 0, 10);
  ASSERT_THAT(page.jobs, SizeIs(2));
  EXPECT_EQ(page.jobs[0].job_id, second);
  EXPECT_EQ(page.jobs[1].job_id, first);
  const JobStatus told = jobs().job(first);
  EXPECT_EQ(page.jobs[1].state, told.state);
  EXPECT_EQ(page.jobs[1].verdict, told.verdict);
  EXPECT_EQ(page.jobs[1].ended_utc, told.ended_utc);
  EXPECT_EQ(page.jobs[1].request.recipe, "texture");

  const auto points = history().values({"texture", "Sa_um"}).points;
  ASSERT_THAT(points, SizeIs(1));
  EXPECT_EQ(points[0].job_id, first);
  EXPECT_EQ(points[0].part_id, "part-1");
  EXPECT_EQ(points[0].ended_utc, told.ended_utc);
  EXPECT_EQ(points[0].value.upper, 0.8);
  EXPECT_EQ(points[0].value.verdict, told.verdict);
  EXPECT_THAT(history().values({"map", "valid_fraction"}).points, SizeIs(2));
  EXPECT_THAT(history().values({"map", "valid_fraction", "part"}).points, SizeIs(1));
  EXPECT_THAT(history().values({"texture", "Sq_um"}).points, IsEmpty());
}

TEST_F(AHistoryOfAMachine, HasTheValuesOfAResultWhoseProcessWasKilledBeforeItsRow) {
  const std::string id = measure(1, "texture");
  ASSERT_TRUE(await([this](const MachineStatus&) { return store_->with_pending_files().empty(); }));
  const auto before = history().values({"texture", "Sa_um"}).points;
  services_->machine.on_change({});
  services_.reset();
  engine_.reset();
  store_.reset();
  Database(folder_.path() / "fvd.sqlite")
      .execute(
          "UPDATE jobs SET state = 'processing', result_dir = '', result_json = '', verdict = '', ended_utc = '';"
          "DELETE FROM job_values");

  JobStore store(folder_.path() / "fvd.sqlite");
  EXPECT_THAT(store.history().values({"texture", "Sa_um"}).points, IsEmpty());
  EXPECT_EQ(reconcile_results(store, folder_.path() / "results").adopted, 1);

  const auto after = store.history().values({"texture", "Sa_um"}).points;
  ASSERT_THAT(after, SizeIs(1));
  EXPECT_EQ(after[0].job_id, id);
  ASSERT_THAT(before, SizeIs(1));
  EXPECT_EQ(after[0].value, before[0].value);
}

TEST_F(AHistoryOfAMachine, KeepsTheValuesOfAResultThatWasRemoved) {
  const std::string id = measure(1, "texture");
  (void)services_->results.acknowledge(ClientSeq{1});
  ASSERT_TRUE(store_->results().mark_removed(id));
  EXPECT_THAT(history().values({"texture", "Sa_um"}).points, SizeIs(1));
}

}  // namespace
}  // namespace fvd
