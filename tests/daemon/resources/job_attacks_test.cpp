/// Ids and names that somebody thought up to get at what is not his.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/resources/job_resource.hpp"
#include "tests/daemon/resources/fake_results.hpp"
#include "tests/daemon/resources/requests.hpp"
#include "tests/daemon/views/made_maps.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;

class AnAttack : public testing::Test {
 protected:
  AnAttack() {
    fs::create_directory(scratch_ / "results");
    test::write_text(scratch_ / "fvd.sqlite", "SECRET");
    test::write_text(scratch_ / "results" / "other", "SECRET");
    results_.add(test::stored_result(scratch_ / "results" / "J7", test::result_with(test::rough(16, 16, 0.2))));
  }
  /// 404, by whom ever it is said, and nothing of what was asked for in the words.
  void expect_nothing_at(const std::string& path) {
    SCOPED_TRACE(path.substr(0, 100));
    std::string words;
    try {
      ResourceAnswer answer = resource_.get(test::request_of(path));
      EXPECT_EQ(answer.status, 404);
      EXPECT_FALSE(answer.source);
      words = test::body_of(answer);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUnknownJob);
      words = error.what();
    }
    EXPECT_LT(words.size(), 300U);
    EXPECT_THAT(words, testing::Not(testing::HasSubstr("SECRET")));
    EXPECT_THAT(words, testing::Not(testing::HasSubstr("<script>")));
  }

  test::ScratchDir scratch_;
  FakeResults results_;
  JobResource resource_{results_};
};

TEST_F(AnAttack, ByAnIdFindsNothing) {
  const std::string with_nul("J7\0x", 4);
  for (const std::string& id : {std::string(),
                                std::string("."),
                                std::string(".."),
                                std::string("..."),
                                std::string("../results/J7"),
                                std::string("../../etc"),
                                std::string("J7/.."),
                                std::string("J7/"),
                                std::string("/J7"),
                                std::string("J7\\"),
                                std::string("J7 "),
                                std::string("%4A7"),
                                std::string("J7;x"),
                                std::string("J7'--"),
                                std::string("<script>"),
                                std::string("J7\r\nX: y"),
                                with_nul,
                                std::string("\xFF\xFE"),
                                std::string(65, 'J'),
                                std::string(10240, 'J'),
                                std::string(10240, '/'),
                                std::string(10240, '.')}) {
    results_.asked.clear();
    expect_nothing_at("/api/v1/jobs/" + id + "/height");
    expect_nothing_at("/api/v1/jobs/" + id + "/files/result.json");
    EXPECT_THAT(results_.asked, testing::IsEmpty()) << "the database is not asked for what is no id";
  }
}

TEST_F(AnAttack, ByANameFindsNothing) {
  fs::create_symlink(scratch_ / "fvd.sqlite", scratch_ / "results" / "J7" / "link.png");
  test::write_text(scratch_ / "results" / "J7" / ".hidden", "SECRET");
  test::write_text(scratch_ / "results" / "J7" / "unlisted.txt", "SECRET");
  const std::string with_nul("result.json\0.png", 16);
  for (const std::string& name : {std::string(),
                                  std::string("/"),
                                  std::string("."),
                                  std::string(".."),
                                  std::string("../other"),
                                  std::string("../../fvd.sqlite"),
                                  std::string("/etc/passwd"),
                                  (scratch_ / "fvd.sqlite").string(),
                                  std::string("./result.json"),
                                  std::string("result.json/"),
                                  std::string("result.json/."),
                                  std::string("x/../result.json"),
                                  std::string("RESULT.JSON"),
                                  std::string("result.json "),
                                  std::string("result.json."),
                                  std::string("result.json\r\nX: y"),
                                  with_nul,
                                  std::string("..%2fother"),
                                  std::string("%2e%2e/other"),
                                  std::string("..\\other"),
                                  std::string("link.png"),
                                  std::string(".hidden"),
                                  std::string("unlisted.txt"),
                                  std::string("*"),
                                  std::string("<script>"),
                                  std::string("\xC0\xAE\xC0\xAE/other"),
                                  std::string(255, 'n'),
                                  std::string(10240, 'n'),
                                  std::string(10240, '/')}) {
    expect_nothing_at("/api/v1/jobs/J7/files/" + name);
  }
}

TEST_F(AnAttack, ByAPathFindsNothing) {
  for (const char* path :
       {"", "/", "/api", "/api/v1/jobs", "/api/v1/jobs/", "/api/v1/jobs//", "/api/v1/jobs/J7", "/api/v1/jobs/J7/",
        "/api/v1/jobs/J7/heights", "/api/v1/jobs/J7/height/", "/api/v1/jobs/J7/HEIGHT", "/api/v1/jobs/J7/files",
        "/api/v1/jobs/J7/files/", "/api/v1/jobs/J7//files/result.json", "/api/v1/jobs/J7/files//result.json",
        "/api/v1/jobs/J7/height/files/result.json", "/API/V1/JOBS/J7/height", "api/v1/jobs/J7/height",
        "/x/api/v1/jobs/J7/height"}) {
    expect_nothing_at(path);
  }
}

TEST_F(AnAttack, ByALinkInTheFolderFindsNothing) {
  StoredJob& job = results_.jobs["J7"];
  auto record = nlohmann::json::parse(job.result_json);
  record["files"].push_back({{"name", "link.png"}, {"state", "written"}});
  record["files"].push_back({{"name", "../../fvd.sqlite"}, {"state", "written"}});
  job.result_json = record.dump();
  fs::create_symlink(scratch_ / "fvd.sqlite", scratch_ / "results" / "J7" / "link.png");
  fs::remove(scratch_ / "results" / "J7" / "height.tiff");
  fs::create_symlink(scratch_ / "fvd.sqlite", scratch_ / "results" / "J7" / "height.tiff");

  expect_nothing_at("/api/v1/jobs/J7/files/link.png");
  expect_nothing_at("/api/v1/jobs/J7/files/height.tiff");
  expect_nothing_at("/api/v1/jobs/J7/files/../../fvd.sqlite");
  expect_nothing_at("/api/v1/jobs/J7/height");
}

}  // namespace
}  // namespace fvd
