#include "daemon/views/result_file.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/daemon/views/made_maps.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class AResultsFiles : public testing::Test {
 protected:
  AResultsFiles() {
    job_ = test::stored_result(scratch_ / "J7", test::result_with(test::rough(7, 5, 0.2)));
    test::write_text(scratch_ / "secret", "not for you");
  }
  /// What was opened, or the error's name.
  std::string open(std::string_view name) {
    auto found = open_result_file(job_, name);
    if (const auto* none = std::get_if<NoFile>(&found)) {
      EXPECT_THAT(none->message, testing::Not(testing::IsEmpty()));
      return none->error;
    }
    const auto& opened = std::get<OpenedFile>(found);
    std::string bytes(opened.size_bytes, '\0');
    EXPECT_EQ(::pread(opened.file.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    return bytes;
  }
  void list(json file) {
    json record = json::parse(job_.result_json);
    record["files"].push_back(std::move(file));
    job_.result_json = record.dump();
  }

  test::ScratchDir scratch_;
  StoredJob job_;
};

TEST_F(AResultsFiles, AreThoseOfItsRecord) {
  EXPECT_TRUE(open("height.tiff") == test::read_text(scratch_ / "J7" / "height.tiff"));
  EXPECT_TRUE(open("result.json") == test::read_text(scratch_ / "J7" / "result.json"));
  EXPECT_EQ(open("height.x3p"), "unknown_file");
  test::write_text(scratch_ / "J7" / "notes.txt", "somebody's");
  EXPECT_EQ(open("notes.txt"), "unknown_file") << "it is there, but not in the record";
}

TEST_F(AResultsFiles, HaveNoPathsForNames) {
  test::write_text(scratch_ / "J7" / "slices", "");
  const std::string with_nul("height.tiff\0.png", 16);
  for (const std::string& name :
       {std::string("../secret"), (scratch_ / "secret").string(), std::string("./height.tiff"), std::string("."),
        std::string(".."), std::string(), std::string("/"), std::string("height.tiff/"), std::string("HEIGHT.TIFF"),
        std::string("slices/z.txt"), std::string("slices/"), with_nul, std::string(10240, 'a'), std::string(10240, '/'),
        std::string("..\\secret"), std::string("%2e%2e%2fsecret")}) {
    EXPECT_EQ(open(name), "unknown_file") << name.substr(0, 40);
  }
}

TEST_F(AResultsFiles, DoNotLeaveTheFolderWhateverTheRecordSays) {
  for (const char* name : {"../secret", "slices/", "..", ".", ""}) list({{"name", name}, {"state", "written"}});
  for (const char* name : {"../secret", "slices/", "..", ".", ""}) EXPECT_EQ(open(name), "unknown_file") << name;
}

TEST_F(AResultsFiles, AreNoLinks) {
  list({{"name", "link.png"}});
  list({{"name", "folder.png"}});
  list({{"name", "gone.png"}});
  fs::create_symlink(scratch_ / "secret", scratch_ / "J7" / "link.png");
  fs::create_directory(scratch_ / "J7" / "folder.png");

  EXPECT_EQ(open("link.png"), "missing");
  EXPECT_EQ(open("folder.png"), "missing");
  EXPECT_EQ(open("gone.png"), "missing");
  fs::rename(scratch_ / "J7", scratch_ / "J8");
  fs::create_directory_symlink(scratch_ / "J8", scratch_ / "J7");
  EXPECT_EQ(open("height.tiff"), "missing") << "nor is the folder";
  fs::remove(scratch_ / "J7");
  EXPECT_EQ(open("height.tiff"), "missing");
}

TEST_F(AResultsFiles, WaitForNoPipe) {
  list({{"name", "pipe"}});
  ASSERT_EQ(::mkfifo((scratch_ / "J7" / "pipe").c_str(), 0600), 0);

  EXPECT_EQ(open("pipe"), "missing");
}

TEST_F(AResultsFiles, AreToldWhereTheyAreNotMadeYetOrNever) {
  list({{"name", "report.pdf"}, {"state", "pending"}});
  list({{"name", "view3d.png"}, {"state", "not_made"}, {"reason", "no point is valid"}});
  list({{"name", "odd.png"}, {"state", "sideways"}});

  EXPECT_EQ(open("report.pdf"), "pending");
  EXPECT_EQ(open("view3d.png"), "not_made");
  EXPECT_EQ(open("odd.png"), "not_made");
}

TEST_F(AResultsFiles, AreNoneWhereTheRecordIsNone) {
  for (const char* record : {"", "no json", "[]", "null", R"({"files": 7})", R"({"files": [7, null, {"name": 7}]})"}) {
    job_.result_json = record;
    EXPECT_EQ(open("height.tiff"), "unknown_file") << record;
  }
  job_.result_dir.clear();
  EXPECT_EQ(open("result.json"), "unknown_file");
}

}  // namespace
}  // namespace fvd
