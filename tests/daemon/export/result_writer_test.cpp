#include "daemon/export/result_writer.hpp"

#include <array>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "daemon/export/result_json.hpp"
#include "daemon/export/step_csv.hpp"
#include "daemon/result/evaluate.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using test::ScratchDir;

std::string json_of(const ResultData& data) { return result_json_text(evaluate(data, test::summary_of(data.map))); }

TEST(ResultWriter, WritesEveryFileAndNothingElse) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  data.extra_maps.emplace_back(PeakMethod::kNearest, test::sample_map());
  write_result(scratch / "job", data);

  EXPECT_THAT(scratch.entries(), testing::ElementsAre("job"));
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "job")) {
    names.insert(entry.path().filename().string());
  }
  EXPECT_THAT(names,
              testing::ElementsAre("height.gsf", "height.tiff", "height_nearest.tiff", "mask.png", "preview.png",
                                   "result.json", "sigma.tiff", "step_log.csv", "texture.png", "texture_view.png"));
}

TEST(ResultWriter, ListsTheFilesWithTheirTrueSizes) {
  const ScratchDir scratch;
  AtomicDirectory directory(scratch / "job");
  directory.add_file("slices/slice_0.pgm", "abc");
  directory.add_file("slices/z.txt", "12345");
  write_result(directory, test::sample_result());
  directory.commit();

  const json result = json::parse(test::read_text(scratch / "job/result.json"));
  ASSERT_EQ(result["files"].size(), 9U);
  EXPECT_EQ(result["files"][0], json({{"name", "slices/"}, {"files", 2}, {"size_bytes", 8}}));
  for (const auto& file : result["files"]) {
    if (file["name"] == "slices/") continue;
    EXPECT_EQ(file["size_bytes"], std::filesystem::file_size(scratch / "job" / file["name"].get<std::string>()));
  }
  EXPECT_GT(result["times"]["write_ms"].get<double>(), 0.0);
}

/// By another program: the digest of the file as it stands.
std::string sha256sum(const std::filesystem::path& file) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("sha256sum '" + file.string() + "'").c_str(), "r"), pclose);
  std::array<char, 65> digits{};
  return pipe && fgets(digits.data(), digits.size(), pipe.get()) != nullptr ? digits.data() : "";
}

TEST(ResultWriter, TellsTheDigestOfEveryFileAsItStands) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  data.exports = {{"tiff", "mask.png", "x3p", "gsf"}};  // some in memory, some in pieces
  AtomicDirectory directory(scratch / "job");
  directory.add_file("slices/slice_0.pgm", "abc");
  write_result(directory, data);
  directory.commit();

  const Result result = read_result_json(test::read_text(scratch / "job/result.json"));
  ASSERT_EQ(result.files.size(), 7U);
  EXPECT_EQ(result.files[0].sha256, "") << "a folder has none";
  for (std::size_t i = 1; i < result.files.size(); ++i) {
    EXPECT_EQ(result.files[i].state, FileState::kWritten);
    EXPECT_EQ(result.files[i].sha256, sha256sum(scratch / ("job/" + result.files[i].name))) << result.files[i].name;
  }
}

TEST(ResultWriter, WritesFirstWhatAVerdictWaitsForAndListsTheRestAsPending) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  data.exports = {{"tiff", "mask.png", "texture.png", "step_log.csv", "x3p", "preview.png", "report.pdf"}};
  AtomicDirectory directory(scratch / "job");
  const FirstFiles files = write_first_files(directory, data);
  directory.commit();

  EXPECT_FALSE(files.is_complete());
  const json result = json::parse(test::read_text(scratch / "job/result.json"));
  std::map<std::string, std::string> states;
  for (const auto& file : result["files"]) states[file["name"]] = file["state"];
  EXPECT_EQ(states, (std::map<std::string, std::string>{{"height.tiff", "written"},
                                                        {"sigma.tiff", "written"},
                                                        {"mask.png", "written"},
                                                        {"texture.png", "written"},
                                                        {"step_log.csv", "written"},
                                                        {"height.x3p", "pending"},
                                                        {"preview.png", "pending"},
                                                        {"report.pdf", "pending"}}));
  for (const auto& [name, state] : states) {
    EXPECT_EQ(std::filesystem::exists(scratch / ("job/" + name)), state == "written") << name;
  }
  ASSERT_EQ(files.written.size(), 5U);
  for (const WrittenBytes& written : files.written) {
    EXPECT_TRUE(written.bytes == test::read_text(scratch / ("job/" + written.name))) << written.name;
  }
}

/// Name and bytes of each file in a folder.
std::map<std::string, std::string> bytes_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files[entry.path().filename().string()] = test::read_text(entry.path());
  }
  return files;
}

TEST(FirstFilesWriter, WritesTheSameWhileTheEvaluationIsMade) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  Evaluation evaluation;
  evaluation.verdict = Verdict::kFail;
  AtomicDirectory begun(scratch / "begun");
  FirstFilesWriter writer(begun, data);
  data.evaluation = evaluation;
  data.times.evaluate_ms = 7.0;
  FirstFiles files = writer.finish();
  begun.commit();
  AtomicDirectory after(scratch / "after");
  const FirstFiles expected = write_first_files(after, data);
  after.commit();

  EXPECT_EQ(files.result.verdict, Verdict::kFail);
  ASSERT_EQ(files.result.files.size(), expected.result.files.size());
  for (std::size_t i = 0; i < files.result.files.size(); ++i) {
    EXPECT_EQ(files.result.files[i].name, expected.result.files[i].name);
    EXPECT_EQ(files.result.files[i].state, expected.result.files[i].state);
    EXPECT_EQ(files.result.files[i].size_bytes, expected.result.files[i].size_bytes);
  }
  EXPECT_EQ(files.written.size(), expected.written.size());
  auto found = bytes_in(scratch / "begun");
  auto wanted = bytes_in(scratch / "after");
  EXPECT_NE(found.at("result.json").find("\"evaluate_ms\": 7"), std::string::npos);
  found.erase("result.json");  // which tells how long it took
  wanted.erase("result.json");
  EXPECT_EQ(found, wanted);
}

TEST(FirstFilesWriter, MakesWhatShowsTheEvaluationAfterIt) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  data.exports = std::vector<std::string>{"report.pdf"};  // which has no heights to follow from
  AtomicDirectory directory(scratch / "job");
  FirstFilesWriter writer(directory, data);
  data.evaluation.emplace();
  const FirstFiles files = writer.finish();

  ASSERT_EQ(files.result.files.size(), 1U);
  EXPECT_EQ(files.result.files[0].name, "report.pdf");
  EXPECT_EQ(files.result.files[0].state, FileState::kWritten);
}

TEST(FirstFilesWriter, TellsAFailureWhenItIsAskedForTheFiles) {
  const ScratchDir scratch;
  const ResultData data = test::sample_result();
  AtomicDirectory directory(scratch / "job");
  directory.add_file("height.tiff", "already here");

  FirstFilesWriter writer(directory, data);

  test::expect_error(ErrorCode::kStorageWrite, {"height.tiff"}, [&] { (void)writer.finish(); });
}

TEST(FirstFilesWriter, LeavesNothingWhereTheJobEndsBeforeItIsAsked) {
  const ScratchDir scratch;
  const ResultData data = test::sample_result();
  {
    AtomicDirectory directory(scratch / "job");
    const FirstFilesWriter writer(directory, data);
  }

  EXPECT_THAT(scratch.entries(), testing::IsEmpty());
}

TEST(ResultWriter, LeavesNothingWhenTheTargetExists) {
  const ScratchDir scratch;
  std::filesystem::create_directory(scratch / "job");
  test::expect_error(ErrorCode::kStorageWrite, {"job", "exists"},
                     [&] { write_result(scratch / "job", test::sample_result()); });
  EXPECT_THAT(scratch.entries(), testing::ElementsAre("job"));
  EXPECT_TRUE(std::filesystem::is_empty(scratch / "job"));
}

TEST(ResultJson, TellsValuesFramesAndOrigin) {
  const json result = json::parse(json_of(test::sample_result()));
  EXPECT_EQ(result["job"], json({{"job_id", "J7"}, {"seq", 4711}, {"part_id", "part-42"}, {"recipe", "chapter"}}));
  EXPECT_EQ(result["values"]["height"],
            json({{"min_um", 2.0}, {"max_um", 25.0}, {"mean_um", 14.0}, {"median_um", 13.5}}));
  EXPECT_EQ(result["values"]["points"], 18);
  EXPECT_EQ(result["values"]["valid_points"], 16);
  EXPECT_NEAR(result["values"]["valid_fraction"].get<double>(), 16.0 / 18.0, 1e-6);
  EXPECT_EQ(result["values"]["hole_points"], json({{"low_prominence", 1},
                                                   {"first_slice", 1},
                                                   {"last_slice", 0},
                                                   {"not_bracketed", 0},
                                                   {"saturated", 1},
                                                   {"insignificant", 0},
                                                   {"edge_bleeding", 0},
                                                   {"broad_curve", 0},
                                                   {"narrow_curve", 0},
                                                   {"second_peak", 0},
                                                   {"edge_band", 0},
                                                   {"max_sigma", 0},
                                                   {"out_of_view", 0}}));
  EXPECT_EQ(result["values"]["sigma_median_um"], 0.2);
  EXPECT_EQ(result["stage_in_curves"]["corrected"], false);
  EXPECT_EQ(result["stage_in_curves"]["offsets_rms_um"], 0.0);
  EXPECT_EQ(result["focus"]["noise_grey"], 1.5);
  EXPECT_EQ(result["focus"]["curve_width_um"], 30.0);
  EXPECT_EQ(result["focus"]["peak"], "log_parabola");
  EXPECT_EQ(result["focus"]["pixel_pitch_y_um"], 4.0);
  EXPECT_EQ(result["focus"]["state_bytes_per_pixel"], 24.0);
  EXPECT_EQ(result["frames"],
            json({{"expected", 4}, {"ok", 3}, {"incomplete", 1}, {"missing", 0}, {"stale", 0}, {"underrun", 0}}));
  EXPECT_EQ(result["slices"], json({{"planned", 3},
                                    {"measured", 2},
                                    {"first_um", 0.0},
                                    {"last_um", 20.0},
                                    {"scan_mode", "step"},
                                    {"suspect", json::array()},
                                    {"retaken", 0},
                                    {"flicker_percent", 0.0},
                                    {"drift_px", nullptr},
                                    {"scale_percent", nullptr}}));
  EXPECT_EQ(result["steps"]["error_max_um"], 0.0625);
  EXPECT_EQ(result["times"], json({{"prepare_ms", 100.0}, {"scan_ms", 2000.0}, {"finish_ms", 5.0}, {"write_ms", 0.0}}));
  EXPECT_EQ(result["provenance"], json({{"recipe", "chapter"},
                                        {"recipe_sha256", "abc"},
                                        {"software_version", "1.2.3"},
                                        {"simulated", true},
                                        {"created", "2023-11-14T22:13:20.123Z"},
                                        {"source", "camera and stage"}}));
}

TEST(ResultJson, HasNullWhereNothingIsKnown) {
  ResultData data = test::sample_result();
  data.job_id.clear();
  data.seq.reset();
  data.pixel_pitch_x_um.reset();
  data.times.scan_ms = std::numeric_limits<double>::quiet_NaN();
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 6; ++x) test::make_hole(data.map, x, y, mask_reason::kLowProminence);
  }
  const std::string text = json_of(data);
  const json result = json::parse(text);
  EXPECT_TRUE(result["job"]["job_id"].is_null());
  EXPECT_TRUE(result["job"]["seq"].is_null());
  EXPECT_TRUE(result["focus"]["pixel_pitch_x_um"].is_null());
  EXPECT_TRUE(result["times"]["scan_ms"].is_null());
  EXPECT_TRUE(result["values"]["height"]["median_um"].is_null());
  EXPECT_EQ(result["values"]["valid_fraction"], 0.0);
  EXPECT_EQ(text.find(": nan"), std::string::npos);
}

TEST(StepCsv, HasOneRowASliceUnderNamesWithUnits) {
  SuspectSlice left_out;
  left_out.index = 2;
  left_out.reason = SuspectReason::kPartial;
  SuspectSlice again = left_out;
  again.index = 0;
  again.done = SuspectDone::kTakenAgain;
  const std::string csv = step_csv(test::sample_result().steps, {again, left_out});
  EXPECT_EQ(csv,
            "index,measured,commanded_um,quantised_um,commanded_counts,move_ms,settle_polls,triggers,"
            "measured_um,measured_sd_um,position_samples,error_um,frame_id,exposure_start_ms,left_out\n"
            "0,1,0.000000,0.000000,0,12.500,4,1,0.062500,0.000000,2,0.062500,7,0.000,\n"
            "1,0,10.000000,10.000000,1000,12.500,4,4,,,,,,,\n"
            "2,1,20.000000,20.000000,2000,12.500,4,1,20.062500,0.000000,2,0.062500,9,40.000,partial\n");
}

TEST(StepCsv, IsAHeaderAloneForAnEmptyLog) {
  const std::string csv = step_csv({});
  EXPECT_EQ(csv.find('\n'), csv.size() - 1);
}

}  // namespace
}  // namespace fvd
