/// Noise and flatness of jobs.

#include <random>

#include <gmock/gmock.h>

#include "daemon/surface_files/surface_readers.hpp"
#include "tests/daemon/study/study_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

class AMapStudy : public test::AStudyDesk {
 protected:
  static constexpr double kNoise_um = 0.2;

  /// White noise on a tilted part; `tilt` differs from scan to scan as drift does.
  void keep_scan(const std::string& id, unsigned seed, double tilt = 0.0, int width = kWidth) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> noise(0.0, kNoise_um);
    ResultData data = surface_data(
        id, [&](int x, int y) { return 0.1 * x * x / 60.0 + 0.02 * y + tilt * x + noise(engine); }, width);
    data.focus.window_px = 1;
    data.focus.focus_operator = FocusOperator::kIntensity;
    keep(data);
  }
  std::vector<std::string> keep_scans(int count) {
    std::vector<std::string> ids;
    for (int i = 0; i < count; ++i) {
      ids.push_back("n" + std::to_string(i));
      keep_scan(ids.back(), static_cast<unsigned>(i) + 1, 0.01 * i);
    }
    return ids;
  }
};

TEST_F(AMapStudy, FindsTheNoiseOfTwoScansThroughTiltAndForm) {
  const Study study = make("verify.noise", NoiseRequest{keep_scans(2), {}});

  EXPECT_NEAR(figure(study, "noise_um"), kNoise_um, 0.05 * kNoise_um);
  const StudyFigure& noise = *study.find("noise_um");
  // White points: u = N_M / sqrt(2 n) of one degree of freedom a point.
  EXPECT_NEAR(noise.u.value(), figure(study, "noise_um") / std::sqrt(2.0 * kWidth * kHeight), 0.01 * *noise.u);
  EXPECT_NEAR(figure(study, "sigma_seen_over_told"), 1.0, 0.05);
  EXPECT_EQ(figure(study, "scan_time_ms"), 2000.0);
  EXPECT_EQ(figure(study, "points"), kWidth * kHeight);
  EXPECT_EQ(study.id, "study-0001");
  EXPECT_EQ(study.person, "anna");
  EXPECT_TRUE(study.simulated);
  EXPECT_EQ(study.recipe_id, "part");
  EXPECT_EQ(study.jobs, (std::vector<std::string>{"n0", "n1"}));
  EXPECT_FALSE(study.proposal);
  EXPECT_TRUE(study.warnings.empty());
}

TEST_F(AMapStudy, LeavesFilesThatAreReadBack) {
  const Study study = make("verify.noise", NoiseRequest{keep_scans(3), {}});

  const auto folder = studies_->folder_of(study.id);
  EXPECT_EQ(study.files, (std::vector<std::string>{"noise_map.gsf", "report.pdf"}));
  const Surface map = read_gsf(folder / "noise_map.gsf");
  EXPECT_EQ(map.width(), kWidth);
  EXPECT_EQ(map.pitch_x_um, 1.0);
  EXPECT_TRUE(test::read_text(folder / "report.pdf").starts_with("%PDF"));
  open_desk();
  EXPECT_EQ(studies_->get(study.id), study);
}

TEST_F(AMapStudy, CountsOnlyTheRegionAndRefusesOneThatLeavesTheField) {
  const auto ids = keep_scans(2);

  const Study part = make("verify.noise", NoiseRequest{ids, {PlannedRectangle{10, 10, 20, 15}}});
  EXPECT_EQ(figure(part, "points"), 300);
  FVD_EXPECT_ERROR_SAYING(kRegionOutside, make("verify.noise", NoiseRequest{ids, {PlannedRectangle{50, 0, 20, 15}}}),
                          HasSubstr("60 x 40 um"));
  FVD_EXPECT_ERROR(kStudyRefused, make("verify.noise", NoiseRequest{ids, {PlannedRectangle{0, 0, 5, 5}}}));
  EXPECT_EQ(kept(), std::set<std::string>{"study-0001"}) << "a study that is refused leaves nothing";
}

TEST_F(AMapStudy, RefusesJobsThatMakeNone) {
  keep_scans(2);
  keep_scan("small", 9, 0.0, kWidth - 1);
  StoredJob failed;
  failed.status.job_id = "failed";
  failed.status.state = JobState::kFailed;
  failed.status.error_message = "the camera is gone";
  jobs_["failed"] = failed;
  ResultData holes = surface_data("holes", [](int, int) { return std::nan(""); });
  keep(holes);

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.noise", NoiseRequest{{"n0"}, {}}), HasSubstr("1 jobs"));
  FVD_EXPECT_ERROR(kStudyRefused, make("verify.noise", NoiseRequest{std::vector<std::string>(21, "n0"), {}}));
  FVD_EXPECT_ERROR_SAYING(kUnknownJob, make("verify.noise", NoiseRequest{{"n0", "nobody"}, {}}), HasSubstr("nobody"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.noise", NoiseRequest{{"n0", "small"}, {}}),
                          HasSubstr("job small has 59 x 40 points"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.noise", NoiseRequest{{"n0", "failed"}, {}}),
                          HasSubstr("the camera is gone"));
  FVD_EXPECT_ERROR(kStudyRefused, make("verify.noise", NoiseRequest{{"n0", "holes"}, {}}));
  std::filesystem::remove(scratch_ / "n1" / "height.tiff");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, make("verify.noise", NoiseRequest{{"n0", "n1"}, {}}), HasSubstr("n1"));
  EXPECT_TRUE(kept().empty());
}

TEST_F(AMapStudy, RefusesWhatDoesNotFitIntoMemoryBeforeItReadsAnything) {
  const auto ids = keep_scans(2);
  open_desk(true, 10000);
  std::filesystem::remove(scratch_ / "n0" / "height.tiff");

  FVD_EXPECT_ERROR_SAYING(kMemoryBudget, make("verify.noise", NoiseRequest{ids, {}}), HasSubstr("fewer jobs"));
}

TEST_F(AMapStudy, EndsWhereItIsAskedToStop) {
  const auto ids = keep_scans(2);
  std::stop_source stop;
  stop.request_stop();

  FVD_EXPECT_ERROR(kShuttingDown, desk_->make({"verify.noise", "", NoiseRequest{ids, {}}}, stop.get_token()));
}

TEST_F(AMapStudy, SaysThatJobsDifferInRecipeOrPart) {
  keep_scans(1);
  ResultData other = surface_data("other", [](int x, int) { return 0.01 * (x % 7); });
  other.recipe_id = "another";
  other.part_id = "part-43";
  keep(other);

  const Study study = make("verify.noise", NoiseRequest{{"n0", "other"}, {}});

  EXPECT_TRUE(warns(study, "recipes_differ"));
  EXPECT_TRUE(warns(study, "parts_differ"));
  EXPECT_EQ(study.recipe_id, "");
}

TEST_F(AMapStudy, RefusesSimulatedAndRealJobsTogether) {
  keep_scans(1);
  ResultData real = surface_data("real", [](int x, int) { return 0.01 * (x % 7); });
  real.simulated = false;
  keep(real);

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.noise", NoiseRequest{{"n0", "real"}, {}}),
                          HasSubstr("simulator"));
}

TEST_F(AMapStudy, FindsTheFlatnessOfTheInstrumentAndProposesIt) {
  // A bow of 2 um across, the same at each place; another slope at each.
  std::vector<std::string> ids;
  for (int i = 0; i < 3; ++i) {
    ids.push_back("f" + std::to_string(i));
    keep(surface_data(ids.back(), [i](int x, int) {
      const double t = (x - 29.5) / 29.5;
      return 2.0 * t * t + 0.01 * i * x + 5.0 * i;
    }));
  }

  const Study verified = make("verify.flatness", FlatnessRequest{ids, {}, {}});
  const Study proposed = make("calibrate.flatness", FlatnessRequest{ids, {}, {}});

  EXPECT_NEAR(figure(verified, "flatness_um"), 2.0, 0.01);
  EXPECT_FALSE(verified.proposal);
  ASSERT_TRUE(proposed.proposal && proposed.proposal->flatness);
  EXPECT_NEAR(proposed.proposal->flatness->flatness_um, 2.0, 0.01);
  const AcceptedConstants accepted =
      desk_->accept({proposed.id, "anna", "C-1", "2027-01-01", std::nullopt}, "2026-11-29");
  const FlatnessConstants& flatness = accepted.calibration.flatness.value();
  EXPECT_EQ(flatness.reference, "cal-0001-flatness.gsf");
  EXPECT_EQ(read_gsf(calibrations_->folder() / flatness.reference).width(), kWidth);
  EXPECT_TRUE(std::filesystem::exists(calibrations_->folder() / "cal-0001-flatness-sigma.gsf"));
}

TEST_F(AMapStudy, GivesNoReferenceMapOfOnePosition) {
  const auto ids = keep_scans(1);

  const Study study = make("calibrate.flatness", FlatnessRequest{ids, {}, {}});

  EXPECT_TRUE(warns(study, "one_position"));
  EXPECT_EQ(study.find("u_reference_um")->reason, "from one position the scatter is not known");
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, desk_->accept({study.id, "anna", "", "2099-01-01", {}}, "2026-11-29"),
                          HasSubstr("two positions"));
}

TEST_F(AMapStudy, GivesMapsToTheSFilterFirst) {
  const std::vector<std::string> ids{"rough"};
  keep(surface_data("rough", [](int x, int y) { return (x + y) % 2 == 0 ? 0.5 : -0.5; }));

  const double all_um = figure(make("verify.flatness", FlatnessRequest{ids, {}, {}}), "flatness_um");
  const double smooth_um = figure(make("verify.flatness", FlatnessRequest{ids, 12.0, {}}), "flatness_um");

  EXPECT_NEAR(all_um, 1.0, 0.01);
  EXPECT_LT(smooth_um, 0.2);
  FVD_EXPECT_ERROR(kStudyRefused, make("verify.flatness", FlatnessRequest{ids, 2.0, {}}));
}

/// Demanded: the noise of two scans within 5 % of the pooled one of 20.
TEST_F(AMapStudy, AgreesFromTwoScansWithTwenty) {
  const auto ids = keep_scans(20);

  const double two_um = figure(make("verify.noise", NoiseRequest{{ids[0], ids[1]}, {}}), "noise_um");
  const double all_um = figure(make("verify.noise", NoiseRequest{ids, {}}), "noise_um");

  const double error = std::abs(two_um / all_um - 1.0);
  RecordProperty("noise_error", std::to_string(error));
  EXPECT_LE(error, 0.05);
  EXPECT_NEAR(all_um, kNoise_um, 0.02 * kNoise_um);
}

}  // namespace
}  // namespace fvd
