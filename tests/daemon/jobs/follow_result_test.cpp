#include "daemon/jobs/follow_result.hpp"

#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/sha256.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using test::ScratchDir;

ResultData with_everything() {
  ResultData data = test::sample_result();
  std::vector<std::string> names;
  for (const Exporter& exporter : exporter_table()) names.emplace_back(exporter.name);
  data.exports = names;
  data.evaluation = test::sample_measurements();
  return data;
}

/// The result of the data with its first files alone.
ResultToFollow first_files(const fs::path& folder, const ResultData& data) {
  AtomicDirectory directory(folder);
  FirstFiles files = write_first_files(directory, data);
  directory.commit();
  return {"J7", folder, test::read_text(folder / "result.json"), std::move(files.written)};
}

std::map<std::string, FileState> states_of(const std::string& text) {
  std::map<std::string, FileState> states;
  for (const ResultFile& file : read_result_json(text).files) states[file.name] = file.state;
  return states;
}

TEST(FollowResult, MakesTheSameBytesAsIfNothingHadFollowed) {
  const ScratchDir scratch;
  const ResultData data = with_everything();
  write_result(scratch / "whole", data);
  const FollowedResult followed = follow_result(first_files(scratch / "job", data), {});

  EXPECT_FALSE(followed.pending);
  EXPECT_EQ(followed.text, test::read_text(scratch / "job/result.json"));
  const Result result = read_result_json(followed.text);
  const Result whole = read_result_json(test::read_text(scratch / "whole/result.json"));
  ASSERT_EQ(result.files.size(), whole.files.size());
  for (const ResultFile& file : result.files) {
    const std::string bytes = test::read_text(scratch / ("job/" + file.name));
    EXPECT_TRUE(bytes == test::read_text(scratch / ("whole/" + file.name))) << file.name;
    EXPECT_EQ(file.state, FileState::kWritten) << file.name;
    EXPECT_EQ(file.size_bytes, bytes.size()) << file.name;
    EXPECT_EQ(file.sha256, sha256_of(bytes)) << file.name;
  }
  EXPECT_TRUE(result.times.follow_ms.has_value());
}

TEST(FollowResult, KeepsColoursAndDeepGreyLevelsOfTheImage) {
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kMono12}) {
    const ScratchDir scratch;
    ResultData data = with_everything();
    data.map.texture_format = format;
    if (format == PixelFormat::kMono8) {
      data.map.colour = Plane<std::uint8_t>(18, 3);
      for (std::size_t i = 0; i < data.map.colour.pixels().size(); ++i) {
        data.map.colour.pixels()[i] = static_cast<std::uint8_t>(3 * i);
      }
    }
    write_result(scratch / "whole", data);
    (void)follow_result(first_files(scratch / "job", data), {});
    EXPECT_TRUE(test::read_text(scratch / "job/height.ply") == test::read_text(scratch / "whole/height.ply"));
  }
}

TEST(FollowResult, WorksWhereTheDistanceOfThePointsIsNotKnown) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  data.pixel_pitch_x_um.reset();
  data.pixel_pitch_y_um.reset();
  write_result(scratch / "whole", data);
  const FollowedResult followed = follow_result(first_files(scratch / "job", data), {});
  EXPECT_FALSE(followed.pending);
  for (const char* name : {"height.gsf", "preview.png"}) {
    EXPECT_TRUE(test::read_text(scratch / "job" / name) == test::read_text(scratch / "whole" / name)) << name;
  }
}

TEST(FollowResult, TakesUpWhatAKilledProcessLeft) {
  const ScratchDir scratch;
  ResultToFollow left = first_files(scratch / "job", with_everything());
  left.written.clear();  // they were in memory
  test::write_text(scratch / "job/.height.gsf.tmp", "half of it");
  test::write_text(scratch / "job/preview.png", "made, but not noted yet");
  const FollowedResult followed = follow_result(left, {});

  for (const ResultFile& file : read_result_json(followed.text).files) {
    EXPECT_EQ(file.sha256, sha256_of(test::read_text(scratch / ("job/" + file.name)))) << file.name;
  }
  EXPECT_NE(test::read_text(scratch / "job/preview.png"), "made, but not noted yet");
  EXPECT_FALSE(fs::exists(scratch / "job/.height.gsf.tmp"));
}

TEST(FollowResult, LeavesTheRestPendingWhenItIsStoppedAndIsFinishedLater) {
  const ScratchDir scratch;
  std::stop_source stop;
  stop.request_stop();
  ResultToFollow task = first_files(scratch / "job", test::sample_result());
  const FollowedResult stopped = follow_result(task, stop.get_token());
  EXPECT_TRUE(stopped.pending);
  EXPECT_EQ(states_of(stopped.text)["preview.png"], FileState::kPending);
  EXPECT_EQ(stopped.text, test::read_text(scratch / "job/result.json"));

  const FollowedResult followed = follow_result({"J7", scratch / "job", stopped.text, {}}, {});
  EXPECT_FALSE(followed.pending);
  EXPECT_TRUE(fs::exists(scratch / "job/preview.png"));
}

TEST(FollowResult, ReadsNoMapWhenItIsStopped) {
  const ScratchDir scratch;
  std::stop_source stop;
  stop.request_stop();
  const ResultToFollow task = first_files(scratch / "job", test::sample_result());
  fs::remove(scratch / "job/height.tiff");
  const FollowedResult stopped = follow_result(task, stop.get_token());
  EXPECT_TRUE(stopped.pending);
  EXPECT_EQ(states_of(stopped.text)["preview.png"], FileState::kPending);
}

TEST(FollowResult, TellsWhyFilesCannotBeMadeAndWaitsForNobody) {
  const ScratchDir scratch;
  const ResultToFollow task = first_files(scratch / "job", test::sample_result());
  fs::resize_file(scratch / "job/height.tiff", 100);
  const FollowedResult followed = follow_result(task, {});
  EXPECT_FALSE(followed.pending);
  for (const ResultFile& file : read_result_json(followed.text).files) {
    if (file.name != "preview.png") continue;
    EXPECT_EQ(file.state, FileState::kNotMade);
    EXPECT_NE(file.reason.find("height.tiff"), std::string::npos) << file.reason;
  }
  EXPECT_EQ(states_of(followed.text)["mask.png"], FileState::kWritten);
}

TEST(FollowResult, TellsOfAFolderThatIsGone) {
  const ScratchDir scratch;
  const ResultToFollow task = first_files(scratch / "job", test::sample_result());
  fs::remove_all(scratch / "job");
  const FollowedResult followed = follow_result(task, {});
  EXPECT_EQ(states_of(followed.text)["preview.png"], FileState::kNotMade);
  EXPECT_EQ(states_of(followed.text)["height.tiff"], FileState::kNotMade);
  EXPECT_FALSE(followed.pending) << "or every start would look for it";
  EXPECT_FALSE(fs::exists(scratch / "job"));
}

TEST(FollowResult, RefusesATextThatIsNoResult) {
  EXPECT_THROW((void)follow_result({"J7", "/nowhere", "{}", {}}, {}), Error);
}

}  // namespace
}  // namespace fvd
