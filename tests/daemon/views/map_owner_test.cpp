#include "daemon/views/map_owner.hpp"

#include <nlohmann/json.hpp>

#include "tests/daemon/resources/fake_results.hpp"
#include "tests/daemon/views/made_maps.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

StoredJob evaluation_of(const std::string& source, const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder);
  StoredJob evaluation;
  evaluation.status.job_id = folder.filename();
  evaluation.status.state = JobState::kCompleted;
  evaluation.result_dir = folder;
  evaluation.result_json = nlohmann::json{{"source", {{"job_id", source}}}}.dump();
  return evaluation;
}

TEST(MapOwner, IsTheJobWhoseSurfaceWasEvaluated) {
  const test::ScratchDir scratch;
  FakeResults results;
  MapCache maps;
  results.add(test::stored_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2))));
  results.add(evaluation_of("J7", scratch / "J7-e1"));
  results.add(evaluation_of("J9", scratch / "J9-e1"));
  results.add(evaluation_of("J8-e1", scratch / "J8-e1"));

  EXPECT_EQ(map_owner(results, "J7", maps)->status.job_id, "J7");
  EXPECT_EQ(map_owner(results, "J7-e1", maps)->status.job_id, "J7");
  EXPECT_EQ(map_owner(results, "J8-e1", maps)->status.job_id, "J8-e1") << "it is its own";
  FVD_EXPECT_ERROR(kUnknownJob, (void)map_owner(results, "J9-e1", maps));
  FVD_EXPECT_ERROR(kUnknownJob, (void)map_owner(results, "J10", maps));
}

TEST(MapOwner, IsNobodyWithoutAResult) {
  const test::ScratchDir scratch;
  FakeResults results;
  MapCache maps;
  StoredJob running;
  running.status.job_id = "J1";
  results.add(running);
  StoredJob removed = test::stored_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2)));
  removed.status.removed_utc = "2026-11-30T10:00:00.000Z";
  results.add(removed);
  results.add(evaluation_of("J7", scratch / "J7-e1"));
  results.add(evaluation_of("J1", scratch / "J1-e1"));

  EXPECT_FALSE(map_owner(results, "J1", maps));
  EXPECT_FALSE(map_owner(results, "J1-e1", maps));
  FVD_EXPECT_ERROR(kResultRemoved, (void)map_owner(results, "J7", maps));
  FVD_EXPECT_ERROR(kResultRemoved, (void)map_owner(results, "J7-e1", maps));
}

TEST(MapOwner, HasNothingOfARemovedResultKeptOpenWhicheverIdIsAskedFor) {
  const test::ScratchDir scratch;
  FakeResults results;
  MapCache maps;
  const StoredJob job = test::stored_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2)));
  results.add(job);
  results.add(evaluation_of("J7", scratch / "J7-e1"));
  for (const char* id : {"J7", "J7-e1"}) {
    results.jobs["J7"].status.removed_utc.clear();
    results.jobs["J7-e1"].status.removed_utc.clear();
    (void)maps.of(map_owner(results, id, maps)->status.job_id, job.result_dir);
    ASSERT_EQ(maps.size(), 1U);
    // As the database tells it: an evaluation is removed with its source.
    results.jobs["J7"].status.removed_utc = "2026-11-30T10:00:00.000Z";
    results.jobs["J7-e1"].status.removed_utc = "2026-11-30T10:00:00.000Z";
    FVD_EXPECT_ERROR(kResultRemoved, (void)map_owner(results, id, maps));
    EXPECT_EQ(maps.size(), 0U) << id;
  }
}

}  // namespace
}  // namespace fvd
