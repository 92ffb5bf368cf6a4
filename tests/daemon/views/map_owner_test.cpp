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
  results.add(test::stored_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2))));
  results.add(evaluation_of("J7", scratch / "J7-e1"));
  results.add(evaluation_of("J9", scratch / "J9-e1"));
  results.add(evaluation_of("J8-e1", scratch / "J8-e1"));

  EXPECT_EQ(map_owner(results, "J7")->status.job_id, "J7");
  EXPECT_EQ(map_owner(results, "J7-e1")->status.job_id, "J7");
  EXPECT_EQ(map_owner(results, "J8-e1")->status.job_id, "J8-e1") << "it is its own";
  FVD_EXPECT_ERROR(kUnknownJob, (void)map_owner(results, "J9-e1"));
  FVD_EXPECT_ERROR(kUnknownJob, (void)map_owner(results, "J10"));
}

TEST(MapOwner, IsNobodyWithoutAResult) {
  const test::ScratchDir scratch;
  FakeResults results;
  StoredJob running;
  running.status.job_id = "J1";
  results.add(running);
  StoredJob removed = test::stored_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2)));
  removed.status.removed_utc = "2026-11-30T10:00:00.000Z";
  results.add(removed);
  results.add(evaluation_of("J7", scratch / "J7-e1"));
  results.add(evaluation_of("J1", scratch / "J1-e1"));

  EXPECT_FALSE(map_owner(results, "J1"));
  EXPECT_FALSE(map_owner(results, "J1-e1"));
  FVD_EXPECT_ERROR(kResultRemoved, (void)map_owner(results, "J7"));
  FVD_EXPECT_ERROR(kResultRemoved, (void)map_owner(results, "J7-e1"));
}

}  // namespace
}  // namespace fvd
