#include "daemon/export/result_json.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/result/evaluate.hpp"
#include "tests/daemon/calibration/some_calibration.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using nlohmann::json;

Result sample() {
  ResultData data = test::sample_result();
  return evaluate(data, test::summary_of(data.map));
}

/// Every field set, each to a value of its own that survives the roundings.
Result full_result() {
  Result result;
  result.job = {"J7", 4711, "part-42"};
  result.recipe = {"chapter", "abc"};
  result.objective = "10x";
  result.temperature = Temperature{21.37, "/run/room.json", 12.5};
  result.calibration = test::whole_calibration();
  result.repeatability = {{"step.height_um", {0.0123456789, 24.0, "study-0007"}}};
  result.verdict = Verdict::kFail;
  result.measurements = {
      {"step", "height_step", 50.125, "um", 0.25, 0.5, 2.0, 90, 0.75, Limits{49.5, 50.5}, Verdict::kPass},
      {"open", "height", std::nullopt, "um", {}, {}, {}, 0, 0.0, Limits{std::nullopt, 3.0}, Verdict::kInvalid},
      {"height_min", "height", 2.5, "um", {}, {}, {}, 16, 0.875, {}, {}}};
  result.warnings = {{"slices_missing", "1 of 3"}, {"range_last", "20 %"}};
  result.points = 18;
  result.valid_points = 16;
  result.holes = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  result.focus.width_px = 6;
  result.focus.height_px = 3;
  result.focus.pixel_pitch_x_um = 2.0;
  result.focus.pixel_pitch_y_um = 4.0;
  result.focus.settings.focus_operator = FocusOperator::kTenengrad;
  result.focus.settings.window_px = 11;
  result.focus.settings.distance_px = 3;
  result.focus.settings.min_prominence = 0.25;
  result.focus.settings.min_significance = 5.5;
  result.focus.settings.tests = {0.25, 0.4, 0.6, 5, 0.75, 1.5};
  result.focus.settings.bin_slices = 4;
  result.focus.noise_grey = 1.5;
  result.focus.curve_width_um = 30.25;
  result.focus.peak = PeakMethod::kLogParabola;
  result.focus.extra_peaks = {{PeakMethod::kNearest, 1.0, 2.0, 1.5, 1.25}, {PeakMethod::kParabola, {}, {}, {}, {}}};
  result.focus.state_bytes_per_pixel = 20.5;
  result.frames = {15, 1, 2, 3, 4, 5};
  result.slices = {21,
                   20,
                   -7.0,
                   193.0,
                   ScanMode::kContinuous,
                   120.5,
                   8,
                   {},
                   1,
                   2.125,
                   Result::Drift{8.875, -0.5, 0.044, -0.0025, DriftUndone::kRecipe},
                   0.125};
  result.slices.suspect = {{3, 30.25, SuspectReason::kDark, 0.125, SuspectDone::kTakenAgain},
                           {17, 170.0, SuspectReason::kVibration, -0.75, SuspectDone::kLeftOut}};
  result.steps = {20, 0.25, 0.5, 0.75, 0.125, 0.375, 12.5, 13.5};
  result.stage = {true, "none", 0.25, 0.125};
  result.times = {1.5, 2.5, 3.5, 4.5};
  result.provenance = {"1.2.3", true,
                       std::chrono::system_clock::time_point(std::chrono::milliseconds(1'700'000'000'123)),
                       "camera and stage"};
  result.times.follow_ms = 5.5;
  result.files = {{"slices/", 22, 1000},
                  {"height.tiff", std::nullopt, 77, FileState::kWritten, "00ff"},
                  {"preview.png", std::nullopt, 0, FileState::kPending},
                  {"report.pdf", std::nullopt, 0, FileState::kNotMade, "", "there is no font"}};
  return result;
}

TEST(ResultJson, IsReadBackWithEveryField) {
  const Result written = full_result();
  const Result read = read_result_json(result_json_text(written));
  EXPECT_EQ(read.job, written.job);
  EXPECT_EQ(read.recipe, written.recipe);
  EXPECT_EQ(read.objective, written.objective);
  EXPECT_EQ(read.temperature, written.temperature);
  EXPECT_EQ(read.calibration, written.calibration);
  EXPECT_EQ(read.repeatability, written.repeatability);
  EXPECT_EQ(read.verdict, written.verdict);
  EXPECT_EQ(read.measurements, written.measurements);
  EXPECT_EQ(read.warnings, written.warnings);
  EXPECT_EQ(read.points, written.points);
  EXPECT_EQ(read.valid_points, written.valid_points);
  EXPECT_EQ(read.holes, written.holes);
  EXPECT_EQ(read.focus.width_px, written.focus.width_px);
  EXPECT_EQ(read.focus.height_px, written.focus.height_px);
  EXPECT_EQ(read.focus.pixel_pitch_x_um, written.focus.pixel_pitch_x_um);
  EXPECT_EQ(read.focus.pixel_pitch_y_um, written.focus.pixel_pitch_y_um);
  EXPECT_EQ(read.focus.settings.focus_operator, written.focus.settings.focus_operator);
  EXPECT_EQ(read.focus.settings.window_px, written.focus.settings.window_px);
  EXPECT_EQ(read.focus.settings.distance_px, written.focus.settings.distance_px);
  EXPECT_EQ(read.focus.settings.min_prominence, written.focus.settings.min_prominence);
  EXPECT_EQ(read.focus.settings.min_significance, written.focus.settings.min_significance);
  EXPECT_EQ(read.focus.settings.tests, written.focus.settings.tests);
  EXPECT_EQ(read.focus.settings.bin_slices, written.focus.settings.bin_slices);
  EXPECT_EQ(read.focus.noise_grey, written.focus.noise_grey);
  EXPECT_EQ(read.focus.curve_width_um, written.focus.curve_width_um);
  EXPECT_EQ(read.focus.peak, written.focus.peak);
  EXPECT_EQ(read.focus.extra_peaks, written.focus.extra_peaks);
  EXPECT_EQ(read.focus.state_bytes_per_pixel, written.focus.state_bytes_per_pixel);
  EXPECT_EQ(read.frames, written.frames);
  EXPECT_EQ(read.slices, written.slices);
  EXPECT_EQ(read.steps.steps, 20);
  EXPECT_EQ(read.stage, written.stage);
  EXPECT_EQ(read.times, written.times);
  EXPECT_EQ(read.provenance, written.provenance);
  EXPECT_EQ(read.files, written.files);
  EXPECT_EQ(result_json_text(read), result_json_text(written));
}

TEST(ResultJson, OfBeforeCalibrationsKnowsNone) {
  json document = json::parse(result_json_text(full_result()));
  for (const char* key : {"objective", "temperature", "calibration", "repeatability"}) document.erase(key);

  const Result read = read_result_json(document.dump());

  EXPECT_EQ(read.objective, "");
  EXPECT_FALSE(read.temperature);
  EXPECT_FALSE(read.calibration);
  EXPECT_TRUE(read.repeatability.empty());
}

TEST(ResultJson, KeepsEveryOtherByteWhereTheListOfFilesIsChanged) {
  Result result = full_result();
  result.times.follow_ms.reset();
  const std::string before = result_json_text(result);
  result.times.follow_ms = 7.125;
  result.files = {{"a.png", std::nullopt, 12, FileState::kWritten, "ab"}};
  EXPECT_EQ(result_json_with_files(before, result.files, 7.125), result_json_text(result));
}

TEST(ResultJson, ReadsFilesOfResultsThatKnewNeitherStateNorDigest) {
  json old = json::parse(result_json_text(full_result()));
  old["files"] = json::array({{{"name", "height.tiff"}, {"size_bytes", 77}}});
  const Result read = read_result_json(old.dump());
  EXPECT_EQ(read.files, (std::vector<ResultFile>{{"height.tiff", std::nullopt, 77}}));

  old["files"][0]["state"] = "perhaps";
  test::expect_error(ErrorCode::kBadInput, {"/files/0/state", "pending"}, [&] { (void)read_result_json(old.dump()); });
}

TEST(ResultJson, IsTheSameTextAgainWhereNothingIsKnown) {
  Result empty;
  empty.times.scan_ms = std::nan("");
  const std::string text = result_json_text(empty);
  EXPECT_EQ(result_json_text(read_result_json(text)), text);
  EXPECT_TRUE(std::isnan(read_result_json(text).times.scan_ms));
}

TEST(ResultJson, TellsItsFormatRecipeVerdictAndMeasurements) {
  ResultData data = test::sample_result();
  data.min_valid_fraction = 0.95;
  const json result = json::parse(result_json_text(evaluate(data, test::summary_of(data.map))));
  EXPECT_EQ(result["format"], 2);
  EXPECT_EQ(result["recipe"], json({{"id", "chapter"}, {"sha256", "abc"}}));
  EXPECT_EQ(result["verdict"], "fail");
  EXPECT_EQ(result["measurements"]["valid_fraction"], json({{"kind", "fraction"},
                                                            {"value", 0.888889},
                                                            {"unit", "1"},
                                                            {"points", 18},
                                                            {"valid_fraction", 1.0},
                                                            {"limits", {{"lower", 0.95}, {"upper", nullptr}}},
                                                            {"verdict", "fail"}}));
  EXPECT_EQ(result["measurements"]["height_max"],
            json({{"kind", "height"}, {"value", 25.0}, {"unit", "um"}, {"points", 16}, {"valid_fraction", 0.888889}}));
  EXPECT_EQ(result["warnings"][0]["code"], "slices_missing");
}

TEST(ResultJson, SurvivesTextThatIsNotUtf8) {
  Result result = sample();
  result.provenance.source = "folder \xFF\xFE";
  EXPECT_TRUE(json::accept(result_json_text(result)));
}

/// One change that makes a good document bad, and the pointer that the refusal must name.
struct BadDocument {
  const char* name;
  std::function<void(json&)> spoil;
  const char* pointer;
};

/// For the names of the tests.
inline void PrintTo(const BadDocument& of, std::ostream* out) { *out << of.name; }

class ABadResultJson : public testing::TestWithParam<BadDocument> {};

TEST_P(ABadResultJson, IsRefusedWithItsPlace) {
  json document = json::parse(result_json_text(full_result()));
  GetParam().spoil(document);
  test::expect_error(ErrorCode::kBadInput, {"result.json", GetParam().pointer},
                     [&] { (void)read_result_json(document.dump()); });
}

INSTANTIATE_TEST_SUITE_P(
    Document, ABadResultJson,
    testing::Values(
        BadDocument{"NoObject", [](json& d) { d = json::array(); }, "/: expected an object"},
        BadDocument{"NoFormat", [](json& d) { d.erase("format"); }, "the key format"},
        BadDocument{"OtherFormat", [](json& d) { d["format"] = 3; }, "/format"},
        BadDocument{"FormatThatIsText", [](json& d) { d["format"] = "2"; }, "/format"},
        BadDocument{"SeqOfOneHalf", [](json& d) { d["job"]["seq"] = 0.5; }, "/job/seq"},
        BadDocument{"SeqTooLarge", [](json& d) { d["job"]["seq"] = 18'446'744'073'709'551'615U; }, "/job/seq"},
        BadDocument{"AmplificationAsText", [](json& d) { d["calibration"]["z"]["alpha_z"] = "1"; },
                    "/calibration/z/alpha_z"},
        BadDocument{"CalibrationWithoutId", [](json& d) { d["calibration"].erase("id"); }, "/calibration/id"},
        BadDocument{"UnknownConstant", [](json& d) { d["calibration"]["z"]["beta"] = 1; }, "/calibration/z/beta"},
        BadDocument{"NoTemperature", [](json& d) { d["temperature"]["celsius"] = nullptr; }, "/temperature/celsius"},
        BadDocument{"NoDegreesOfFreedom", [](json& d) { d["repeatability"]["step.height_um"]["dof"] = 0; },
                    "/repeatability/step.height_um/dof"},
        BadDocument{"ObjectiveAsNumber", [](json& d) { d["objective"] = 10; }, "/objective"},
        BadDocument{"UnknownVerdict", [](json& d) { d["verdict"] = "good"; }, "/verdict"},
        BadDocument{"MeasurementsAsList", [](json& d) { d["measurements"] = json::array(); }, "/measurements"},
        BadDocument{"ValueThatIsText", [](json& d) { d["measurements"]["step"]["value"] = "50"; },
                    "/measurements/step/value"},
        BadDocument{"LimitsWithoutUpper", [](json& d) { d["measurements"]["step"]["limits"].erase("upper"); },
                    "/measurements/step/limits"},
        BadDocument{"NegativePoints", [](json& d) { d["values"]["points"] = -1; }, "/values/points"},
        BadDocument{"MissingHoleCount", [](json& d) { d["values"]["hole_points"].erase("saturated"); },
                    "/values/hole_points"},
        BadDocument{"UnknownPeak", [](json& d) { d["focus"]["peak"] = "highest"; }, "/focus/peak"},
        BadDocument{"UnknownOperator", [](json& d) { d["focus"]["operator"] = 3; }, "/focus/operator"},
        BadDocument{"BadFurtherHeight", [](json& d) { d["focus"]["extra_peaks"][1]["height"]["max_um"] = true; },
                    "/focus/extra_peaks/1/height/max_um"},
        BadDocument{"WidthBeyondInt", [](json& d) { d["focus"]["width_px"] = 3'000'000'000; }, "/focus/width_px"},
        BadDocument{"UnknownScanMode", [](json& d) { d["slices"]["scan_mode"] = "fast"; }, "/slices/scan_mode"},
        BadDocument{"SuspectThatIsText", [](json& d) { d["slices"]["suspect"][1] = "3"; }, "/slices/suspect/1"},
        BadDocument{"UnknownReason", [](json& d) { d["slices"]["suspect"][0]["reason"] = "odd"; },
                    "/slices/suspect/0/reason"},
        BadDocument{"NoWarningCode", [](json& d) { d["warnings"][0].erase("code"); }, "/warnings/0"},
        BadDocument{"SimulatedAsNumber", [](json& d) { d["provenance"]["simulated"] = 1; }, "/provenance/simulated"},
        BadDocument{"NoTime", [](json& d) { d["provenance"]["created"] = "yesterday"; }, "/provenance/created"},
        BadDocument{"TimeWithoutZone", [](json& d) { d["provenance"]["created"] = "2023-11-14T22:13:20.123"; },
                    "/provenance/created"},
        BadDocument{"FileWithoutSize", [](json& d) { d["files"][1].erase("size_bytes"); }, "/files/1"}),
    [](const auto& document) { return document.param.name; });

TEST(ResultJson, IsRefusedWhereItIsNoJson) {
  for (const char* text : {"", "{", "{\"format\": 2", "\xFF"}) {
    test::expect_error(ErrorCode::kBadInput, {"result.json", "JSON"}, [text] { (void)read_result_json(text); });
  }
}

}  // namespace
}  // namespace fvd
