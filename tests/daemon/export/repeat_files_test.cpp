/// The files and figures of a result whose map is the mean of several scans.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/export/exporter_table.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/result/evaluate.hpp"
#include "daemon/surface_files/surface_files.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

ResultData mean_of_four() {
  ResultData data = test::sample_result();
  data.repeated = RepeatedScans{4, Plane<float>(6, 3, 0.25e-6F), 0.25};
  data.repeated->sd_m.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  data.slices_planned = 12;
  data.slices_measured_before = 8;
  data.suspects_before.push_back({.index = 1, .done = SuspectDone::kLeftOut});
  return data;
}

Result evaluated(const ResultData& data) { return evaluate(data, test::summary_of(data.map)); }

TEST(RepeatedScansResult, TellsHowManyAndTheirScatter) {
  const Result result = evaluated(mean_of_four());

  ASSERT_TRUE(result.repeat.has_value());
  EXPECT_EQ(result.repeat->scans, 4);
  EXPECT_EQ(result.repeat->sd_rms_um, 0.25);
  EXPECT_EQ(result.slices.planned, 12);
  EXPECT_EQ(result.slices.measured, 10) << "eight of the scans before, two of three of the last";
  EXPECT_EQ(result.slices.suspect.size(), 1U);
  const std::string text = result_json_text(result);
  EXPECT_EQ(json::parse(text)["repeat"], json({{"scans", 4}, {"sd_rms_um", 0.25}}));
  EXPECT_EQ(read_result_json(text).repeat, result.repeat);
}

TEST(RepeatedScansResult, TellsNoScatterThatIsNotThere) {
  ResultData data = mean_of_four();
  data.repeated->sd_rms_um.reset();

  const std::string text = result_json_text(evaluated(data));

  EXPECT_TRUE(json::parse(text)["repeat"]["sd_rms_um"].is_null());
  EXPECT_EQ(read_result_json(text).repeat, (Result::Repeat{4, std::nullopt}));
}

TEST(RepeatedScansResult, IsNotToldOfOneScan) {
  const std::string text = result_json_text(evaluated(test::sample_result()));

  EXPECT_FALSE(json::parse(text).contains("repeat"));
  EXPECT_FALSE(read_result_json(text).repeat.has_value());
}

TEST(RepeatedScansFiles, HoldTheScatterAtEachPoint) {
  const test::ScratchDir folder;
  AtomicDirectory directory(folder.path() / "r");
  write_result(directory, mean_of_four(),
               chosen_exporters(std::vector<std::string>{"repeat_sd.tiff", "repeat_sd.gsf"}));
  directory.commit();

  for (const char* name : {"repeat_sd.tiff", "repeat_sd.gsf"}) {
    const Surface sd = read_surface(folder.path() / "r" / name, {.pitch_x_um = 2.0, .pitch_y_um = 4.0});
    EXPECT_EQ(sd.height_m.width(), 6) << name;
    EXPECT_EQ(sd.height_m.at(1, 0), 0.25e-6F) << name << ": also where the mean of this sample has a hole";
    EXPECT_TRUE(std::isnan(sd.height_m.at(0, 0))) << name;
  }
}

TEST(RepeatedScansFiles, AreNotMadeOfOneScan) {
  const test::ScratchDir folder;
  AtomicDirectory directory(folder.path() / "r");
  write_result(directory, test::sample_result(), chosen_exporters(std::vector<std::string>{"repeat_sd.tiff"}));
  directory.commit();

  EXPECT_FALSE(std::filesystem::exists(folder.path() / "r" / "repeat_sd.tiff"));
}

}  // namespace
}  // namespace fvd
