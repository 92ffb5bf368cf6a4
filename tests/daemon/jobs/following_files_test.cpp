#include "daemon/jobs/following_files.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "daemon/export/result_json.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/jobs/engine_bench.hpp"

namespace fvd {
namespace {

using test::AnEngine;

bool has_pending(const std::string& text) {
  const Result result = read_result_json(text);
  return std::any_of(result.files.begin(), result.files.end(),
                     [](const ResultFile& file) { return file.state == FileState::kPending || file.sha256.empty(); });
}

/// A store with an ended job whose result has its first files alone.
class AStoreWithPendingFiles : public testing::Test {
 protected:
  AStoreWithPendingFiles() {
    JobStatus job = store_.accept({1, "part", "chapter"});
    AtomicDirectory directory(scratch_ / "result");
    const FirstFiles files = write_first_files(directory, test::sample_result());
    directory.commit();
    job.state = JobState::kCompleted;
    job_id_ = job.job_id;
    store_.finish(job, (scratch_ / "result").string(), result_json_text(files.result), true);
  }

  test::ScratchDir scratch_;
  JobStore store_{scratch_ / "fvd.sqlite"};
  std::string job_id_;
};

TEST_F(AStoreWithPendingFiles, HasThemMadeAtTheNextStart) {
  ASSERT_EQ(store_.with_pending_files().size(), 1U);
  {
    FollowingFiles following(store_);
    EXPECT_GT(following.bytes(), 0U);
    following.start();
    ASSERT_TRUE(following.wait_for(0, {}));
  }
  EXPECT_TRUE(store_.with_pending_files().empty());
  const std::string text = store_.find(job_id_).result_json;
  EXPECT_FALSE(has_pending(text));
  EXPECT_EQ(text, test::read_text(scratch_ / "result/result.json"));
}

TEST_F(AStoreWithPendingFiles, KeepsThemForTheStartAfterAStop) {
  {
    FollowingFiles following(store_);
    following.finish();  // before it began
  }
  EXPECT_EQ(store_.with_pending_files().size(), 1U);
  EXPECT_TRUE(has_pending(store_.find(job_id_).result_json));
}

TEST_F(AStoreWithPendingFiles, LetsAJobGoOnThatIsStoppedWhileItWaitsForThem) {
  FollowingFiles following(store_);  // nobody makes them
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(following.wait_for(0, stop.get_token()));
  EXPECT_TRUE(following.wait_for(following.bytes(), {})) << "there is room";
}

TEST_F(AnEngine, TellsAVerdictBeforeTheOtherFilesOfTheResult) {
  std::string first_text;
  open([&first_text](AtomicDirectory& directory, const ResultData& acquired, FirstFilesWriter* begun) {
    JobResult result = store_result(directory, acquired, begun);
    first_text = result.text;
    return result;
  });
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  const std::string job_id = jobs().start({1, "a", "part"}).job.job_id;
  ASSERT_TRUE(await_end_of(1));
  EXPECT_TRUE(has_pending(first_text));
  const auto folder = folder_.path() / "results" / job_id;
  EXPECT_TRUE(std::filesystem::exists(folder / "height.tiff"));
  ASSERT_TRUE(await([&](const MachineStatus&) { return store_->with_pending_files().empty(); }));
  EXPECT_FALSE(has_pending(store_->find(job_id).result_json));
  EXPECT_TRUE(std::filesystem::exists(folder / "preview.png"));
}

}  // namespace
}  // namespace fvd
