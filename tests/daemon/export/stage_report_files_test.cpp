#include "daemon/export/stage_report_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/core/stage/synthetic_stage.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using test::ScratchDir;
using testing::Contains;
using testing::HasSubstr;

const StageReportHeader kHeader{"oriental-az", "127.0.0.1:502 unit 1",
                                std::chrono::sys_days{std::chrono::year{2026} / 11 / 24} + std::chrono::hours(9),
                                "0.1.0", true};

struct Reported {
  std::vector<StagePoint> points;
  StageReport report;
};

Reported reported(FeedbackSource feedback, const test::SyntheticStage& stage = {}) {
  Reported result{test::synthetic_points(stage), {}};
  StageReportOptions options = test::scale_options();
  options.feedback = feedback;
  if (feedback == FeedbackSource::kNone) {
    for (auto& p : result.points) p.measured_um = std::numeric_limits<double>::quiet_NaN();
  }
  result.report = make_stage_report(result.points, options);
  return result;
}

cv::Mat picture_of(const Reported& r, const std::string& keep_as) {
  const std::string bytes = stage_report_png(r.points, r.report, kHeader);
  // For people who want to look: FVD_KEEP_PLOTS=/some/folder
  const char* folder = std::getenv("FVD_KEEP_PLOTS");
  const cv::Mat image = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_UNCHANGED);
  if (folder != nullptr) cv::imwrite(std::string(folder) + "/" + keep_as + ".png", image);
  return image;
}

/// Pixels inside the frame that are neither white nor grey.
int coloured_pixels(const cv::Mat& page) {
  int count = 0;
  for (int y = 112; y < 642; ++y) {
    for (int x = 84; x < 860; ++x) {
      const auto p = page.at<cv::Vec3b>(y, x);
      if (std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) > 40) ++count;
    }
  }
  return count;
}

TEST(StageReportFiles, WritesThreeFilesAndNothingElse) {
  const ScratchDir scratch;
  const auto [points, report] = reported(FeedbackSource::kLinearScale);
  write_stage_report(scratch / "check", points, report, kHeader);
  EXPECT_THAT(scratch.entries(), testing::ElementsAre("check"));
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "check")) {
    names.insert(entry.path().filename().string());
    EXPECT_GT(entry.file_size(), 0U);
  }
  EXPECT_THAT(names, testing::ElementsAre("stage_accuracy.csv", "stage_accuracy.json", "stage_accuracy.png"));
}

TEST(StageReportFiles, RefusesAReportOfOtherPoints) {
  const ScratchDir scratch;
  auto measured = reported(FeedbackSource::kLinearScale);
  measured.points.pop_back();
  test::expect_error(ErrorCode::kBadInput, {"366", "365"},
                     [&] { write_stage_report(scratch / "check", measured.points, measured.report, kHeader); });
  EXPECT_THAT(scratch.entries(), testing::IsEmpty());
}

TEST(StageReportJson, HoldsTheFiguresWithTheirOrigin) {
  const auto [points, report] = reported(FeedbackSource::kLinearScale);
  const json text = json::parse(stage_report_json(report, kHeader));
  EXPECT_EQ(text["provenance"]["profile"], "oriental-az");
  EXPECT_EQ(text["provenance"]["date"], "2026-11-24T09:00:00.000Z");
  EXPECT_EQ(text["provenance"]["feedback"], "linear_scale");
  EXPECT_EQ(text["provenance"]["simulated"], true);
  EXPECT_EQ(text["observable"], true);
  EXPECT_EQ(text["points"], 366);
  EXPECT_NEAR(text["fit"]["alpha_z"].get<double>(), 1.0004, 5e-5);
  EXPECT_NEAR(text["fit"]["lead_error"]["amplitude_um"].get<double>(), 0.3, 0.01);
  EXPECT_NEAR(text["fit"]["lead_error"]["phase_deg"].get<double>(), 40.0, 3.0);
  EXPECT_NEAR(text["reversal"]["mean_um"].get<double>(), 0.8, 0.02);
  EXPECT_NEAR(text["drift"]["um_per_min"].get<double>(), 0.25, 0.0125);
  EXPECT_TRUE(text["drift"]["um_per_k"].is_null()) << "no temperature was given";
  for (const char* key : {"mean_um", "sd_um", "max_um", "p95_um"}) {
    for (const char* block : {"error", "error_to_command", "quantisation", "increment_error"}) {
      EXPECT_TRUE(text[block][key].is_number()) << block << key;
    }
  }
  EXPECT_TRUE(text["straight_line"]["l_z_um"].is_number());
  EXPECT_TRUE(text["repeatability"]["pooled_sd_um"].is_number());
  EXPECT_TRUE(text["settle"]["p95_ms"].is_number());
  EXPECT_EQ(text["step_quantum_um"], 0.01);
  EXPECT_TRUE(text["definitions"]["reversal"].is_string());
}

TEST(StageReportJson, HasNoNumberForWhatWasNotObserved) {
  const auto [points, report] = reported(FeedbackSource::kNone);
  const json text = json::parse(stage_report_json(report, kHeader));
  EXPECT_EQ(text["observable"], false);
  EXPECT_THAT(text["caveats"].get<std::vector<std::string>>(), Contains(HasSubstr("not observable")));
  for (const char* key : {"error", "error_to_command", "increment_error", "straight_line", "fit", "reversal",
                          "repeatability", "drift", "feedback_resolution_um"}) {
    ASSERT_TRUE(text.contains(key)) << key;
    EXPECT_TRUE(text[key].is_null()) << key;
  }
  EXPECT_TRUE(text["quantisation"]["max_um"].is_number());
}

TEST(StageReportCsv, HasOneLineAPointAndEveryColumn) {
  const auto [points, report] = reported(FeedbackSource::kLinearScale);
  const std::string csv = stage_report_csv(points, report);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 367);
  const std::string none = stage_report_csv(points, reported(FeedbackSource::kNone).report);
  for (const std::string& text : {csv, none}) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      ASSERT_EQ(std::count(line.begin(), line.end(), ','), 14) << line;
    }
  }
  EXPECT_THAT(csv.substr(csv.find('\n') + 1), testing::StartsWith("0,0.000000,0,1,120.000000,120.000000,0.000000,"));
  EXPECT_THAT(none, HasSubstr(",,,,,\n")) << "temperature and measured columns";
}

TEST(StageReportPlot, ShowsPointsCurvesAndFigures) {
  const cv::Mat page = picture_of(reported(FeedbackSource::kLinearScale), "scale");
  ASSERT_EQ(page.size(), cv::Size(1200, 800));
  ASSERT_EQ(page.type(), CV_8UC3);
  EXPECT_GT(coloured_pixels(page), 5000);
}

TEST(StageReportPlot, SaysNotObservableWithoutFeedback) {
  const cv::Mat page = picture_of(reported(FeedbackSource::kNone), "none");
  ASSERT_EQ(page.size(), cv::Size(1200, 800));
  EXPECT_EQ(coloured_pixels(page), 0) << "no point, no curve";
  const cv::Mat words = page(cv::Rect(84 + 200, 112 + 240, 376, 60));
  EXPECT_LT(cv::mean(words)[0], 245.0) << "the words are in the middle";
}

TEST(StageReportPlot, DrawsWhateverThereIs) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    Reported few = reported(FeedbackSource::kLinearScale);
    few.points.resize(n);
    few.report = make_stage_report(few.points, test::scale_options());
    EXPECT_FALSE(picture_of(few, "few" + std::to_string(n)).empty()) << n;
  }
  test::SyntheticStage still;
  still.positions = 1;
  still.noise_um = still.drift_um_per_min = still.reversal_um = 0.0;
  EXPECT_FALSE(picture_of(reported(FeedbackSource::kLinearScale, still), "still").empty());
  test::SyntheticStage short_lead;
  short_lead.lead_um = 1000.0;
  short_lead.range_um = 60'000.0;
  short_lead.positions = 601;
  short_lead.down = false;
  short_lead.temperature_c = [](double s) { return 20.0 + std::sin(s / 200.0); };
  EXPECT_FALSE(picture_of(reported(FeedbackSource::kMotorEncoder, short_lead), "long").empty());
}

}  // namespace
}  // namespace fvd
