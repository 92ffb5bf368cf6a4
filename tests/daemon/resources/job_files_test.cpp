/// Files of results by GET.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/resources/job_resource.hpp"
#include "tests/daemon/resources/fake_results.hpp"
#include "tests/daemon/resources/requests.hpp"
#include "tests/daemon/views/made_maps.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using test::body_of;
using test::field_of;
using test::request_of;

class JobFiles : public testing::Test {
 protected:
  JobFiles() {
    results_.add(test::stored_result(scratch_ / "J7", test::result_with(test::rough(40, 30, 0.2))));
    content_ = test::read_text(scratch_ / "J7" / "height.tiff");
  }
  static ResourceRequest asked(const std::string& name) { return request_of("/api/v1/jobs/J7/files/" + name); }
  static ResourceRequest part(const std::string& range) {
    ResourceRequest request = asked("height.tiff");
    request.range = range;
    return request;
  }
  std::string error_of(const ResourceRequest& request, int status = 404) {
    const ResourceAnswer answer = resource_.get(request);
    EXPECT_EQ(answer.status, status) << answer.body;
    return nlohmann::json::parse(answer.body).value("error", "");
  }
  /// Adds a file to the folder and to the record.
  void add(const std::string& name, const std::string& content) {
    test::write_text(scratch_ / "J7" / name, content);
    StoredJob& job = results_.jobs["J7"];
    auto record = nlohmann::json::parse(job.result_json);
    record["files"].push_back({{"name", name}, {"state", "written"}});
    job.result_json = record.dump();
  }

  test::ScratchDir scratch_;
  FakeResults results_;
  JobResource resource_{results_};
  std::string content_;
};

TEST_F(JobFiles, AreSentAsAttachments) {
  ResourceAnswer answer = resource_.get(asked("height.tiff"));

  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(field_of(answer, "Content-Type"), "image/tiff");
  EXPECT_EQ(field_of(answer, "Content-Disposition"), R"(attachment; filename="height.tiff")");
  EXPECT_EQ(field_of(answer, "Accept-Ranges"), "bytes");
  EXPECT_EQ(field_of(answer, "Cache-Control"), "private, no-cache");
  EXPECT_THAT(field_of(answer, "ETag"), testing::MatchesRegex("\"[0-9a-f-]+\""));
  EXPECT_EQ(field_of(answer, "Content-Range"), "");
  EXPECT_TRUE(body_of(answer) == content_);
  ResourceAnswer record = resource_.get(asked("result.json"));
  EXPECT_TRUE(body_of(record) == test::read_text(scratch_ / "J7" / "result.json"));
}

TEST_F(JobFiles, MayBeEmptyOrLarge) {
  add("empty.txt", "");
  std::string large;
  while (large.size() < 3000000) large += std::to_string(large.size());
  add("large.ply", large);

  ResourceAnswer empty = resource_.get(asked("empty.txt"));
  ResourceAnswer whole = resource_.get(asked("large.ply"));
  ResourceRequest request = asked("large.ply");
  request.range = "bytes=1000000-2500000";
  ResourceAnswer range = resource_.get(request);
  request = asked("empty.txt");
  request.range = "bytes=0-";

  EXPECT_EQ(empty.status, 200);
  EXPECT_EQ(body_of(empty), "");
  EXPECT_EQ(error_of(request, 416), "no_such_range");
  EXPECT_TRUE(body_of(whole) == large);
  EXPECT_TRUE(body_of(range) == large.substr(1000000, 1500001));
}

TEST_F(JobFiles, AreSentInPart) {
  const std::string size = std::to_string(content_.size());
  const auto expect_part = [&](const std::string& range, std::size_t first, std::size_t bytes) {
    ResourceAnswer answer = resource_.get(part(range));
    EXPECT_EQ(answer.status, 206) << range;
    EXPECT_EQ(field_of(answer, "Content-Range"),
              "bytes " + std::to_string(first) + "-" + std::to_string(first + bytes - 1) + "/" + size);
    EXPECT_EQ(field_of(answer, "Content-Type"), "image/tiff");
    EXPECT_NE(field_of(answer, "ETag"), "");
    EXPECT_TRUE(body_of(answer) == content_.substr(first, bytes)) << range;
  };

  expect_part("bytes=0-0", 0, 1);
  expect_part("bytes=100-199", 100, 100);
  expect_part("bytes=100-", 100, content_.size() - 100);
  expect_part("bytes=-100", content_.size() - 100, 100);
  expect_part("bytes=0-99999999", 0, content_.size());
}

TEST_F(JobFiles, HaveNothingBeyondTheirEnd) {
  const ResourceAnswer answer = resource_.get(part("bytes=" + std::to_string(content_.size()) + "-"));

  EXPECT_EQ(answer.status, 416);
  EXPECT_EQ(field_of(answer, "Content-Range"), "bytes */" + std::to_string(content_.size()));
  EXPECT_EQ(field_of(answer, "Content-Type"), "application/json");
  EXPECT_FALSE(answer.source);
}

TEST_F(JobFiles, AreSentWholeWhereTheRangeIsNone) {
  for (const char* range : {"bytes=5-1", "bytes=1-2,4-5", "items=0-5", "bytes=a-b", ""}) {
    ResourceAnswer answer = resource_.get(part(range));
    EXPECT_EQ(answer.status, 200) << range;
    EXPECT_TRUE(body_of(answer) == content_) << range;
  }
}

TEST_F(JobFiles, AreSentInPartOnlyWhileTheyAreTheSame) {
  const std::string tag = field_of(resource_.get(asked("height.tiff")), "ETag");
  ResourceRequest request = part("bytes=0-9");
  request.if_range = tag;
  EXPECT_EQ(resource_.get(request).status, 206);
  request.if_range = "W/" + tag;
  EXPECT_EQ(resource_.get(request).status, 200);
  request.if_range = "Mon, 30 Nov 2026 10:00:00 GMT";
  EXPECT_EQ(resource_.get(request).status, 200);

  test::write_text(scratch_ / "new", content_);
  std::filesystem::rename(scratch_ / "new", scratch_ / "J7" / "height.tiff");
  request.if_range = tag;

  EXPECT_EQ(resource_.get(request).status, 200);
}

TEST_F(JobFiles, ThatAreKnownAreNotSentAgain) {
  ResourceRequest request = part("bytes=0-9");
  const std::string tag = field_of(resource_.get(request), "ETag");
  request.if_none_match = tag;

  const ResourceAnswer known = resource_.get(request);

  EXPECT_EQ(known.status, 304);
  EXPECT_EQ(field_of(known, "ETag"), tag);
  EXPECT_FALSE(known.source);
}

TEST_F(JobFiles, AnswerHeadWithoutARange) {
  ResourceRequest request = part("bytes=0-9");
  request.is_head = true;

  const ResourceAnswer head = resource_.get(request);

  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.source_bytes, content_.size());
}

TEST_F(JobFiles, AreRefusedWhereThereAreNone) {
  StoredJob running;
  running.status.job_id = "J1";
  results_.add(running);

  EXPECT_EQ(error_of(asked("height.x3p")), "unknown_file");
  EXPECT_EQ(error_of(request_of("/api/v1/jobs/J1/files/result.json")), "no_result");
  FVD_EXPECT_ERROR(kUnknownJob, (void)resource_.get(request_of("/api/v1/jobs/J9/files/result.json")));
  std::filesystem::remove(scratch_ / "J7" / "height.tiff");
  EXPECT_EQ(error_of(asked("height.tiff")), "missing");
  results_.jobs["J7"].status.removed_utc = "2026-11-30T10:00:00.000Z";
  FVD_EXPECT_ERROR(kResultRemoved, (void)resource_.get(asked("result.json")));
}

}  // namespace
}  // namespace fvd
