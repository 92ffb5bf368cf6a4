/// Lateral scale, lateral resolution and probing errors, of jobs of one artefact.

#include <random>
#include <sstream>

#include <gmock/gmock.h>

#include "daemon/surface_files/surface_readers.hpp"
#include "tests/daemon/study/study_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

constexpr double kWindow_px = 9.0;

/// The share of a box about a place that lies within half_px of 0.
double boxed(double distance_px, double half_px) {
  const double low = std::max(distance_px - 0.5 * kWindow_px, -half_px);
  const double high = std::min(distance_px + 0.5 * kWindow_px, half_px);
  return std::max(0.0, high - low) / kWindow_px;
}

/// A cross grid as a window shows it: pitches of 80 columns and 75 rows, lines 28 wide and 20 um high.
struct Grid {
  double right_px = 0.0;
  double down_px = 0.0;
  double z_um = 100.0;

  double operator()(int x, int y) const {
    const double across = boxed(std::remainder(x - right_px - 41.25, 80.0), 14.0);
    const double along = boxed(std::remainder(y - down_px - 33.5, 75.0), 14.0);
    return z_um + 20.0 * (1.0 - (1.0 - across) * (1.0 - along));
  }
};

class AnArtefactStudy : public test::AStudyDesk {
 protected:
  static constexpr int kGridWidth = 400;
  static constexpr int kGridHeight = 300;

  void keep_grid(const std::string& id, const Grid& grid, const std::function<void(ResultData&)>& change = {}) {
    ResultData data = surface_data(id, grid, kGridWidth, kGridHeight);
    if (change) change(data);
    keep(data);
  }
  static LateralRequest grid_of(const std::string& job, const std::string& second = "") {
    LateralRequest request;
    request.job = job;
    request.second_job = second;
    request.grid_pitch_um = 40.0;
    request.u_grid_relative = 1e-4;
    return request;
  }
  /// A cap of 200 um radius that stands on a base `rim_um` beside its axis, which is at (90.5, 85.5).
  void keep_cap(const std::string& id, double rim_um) {
    std::mt19937 engine(3);
    std::normal_distribution<double> noise(0.0, 0.03);
    ResultData data = surface_data(
        id,
        [&](int x, int y) {
          const double across = std::min(rim_um, std::hypot(x - 90.0, y - 85.0));
          return 50.0 + std::sqrt(200.0 * 200.0 - across * across) - 200.0 + noise(engine);
        },
        180, 170);
    data.focus.window_px = 5;
    keep(data);
  }
  AcceptedConstants accept(const Study& study) {
    return desk_->accept({study.id, "anna", "", "2099-01-01", std::nullopt}, "2026-11-29");
  }
};

TEST_F(AnArtefactStudy, FindsThePitchOfBothAxesAndProposesIt) {
  keep_grid("grid", {});

  const Study study = make("calibrate.lateral", grid_of("grid"));

  EXPECT_NEAR(figure(study, "pitch_x_um"), 40.0 / 80.0, 1e-5);
  EXPECT_NEAR(figure(study, "pitch_y_um"), 40.0 / 75.0, 1e-5);
  EXPECT_NEAR(study.find("pitch_x_um")->u.value(), 0.5e-4, 1e-5) << "the certificate's";
  EXPECT_NEAR(figure(study, "shear"), 0.0, 1e-4);
  EXPECT_NEAR(figure(study, "line_width_x_um"), 14.0, 0.1);
  EXPECT_EQ(figure(study, "crossings"), 20.0);
  EXPECT_EQ(study.find("drift_x_px_per_um")->value, std::nullopt);
  EXPECT_THAT(study.find("drift_x_px_per_um")->reason, HasSubstr("another height"));
  EXPECT_TRUE(warns(study, "pitch_far")) << "the job was measured with 1 x 1 um";
  ASSERT_TRUE(study.proposal && study.proposal->lateral);
  EXPECT_EQ(study.proposal->lateral->pitch_y_um, figure(study, "pitch_y_um"));
  EXPECT_EQ(study.proposal->lateral->u_pitch_x_um, study.find("pitch_x_um")->u.value());
}

TEST_F(AnArtefactStudy, LeavesTheMappingDeviationsAsAFile) {
  keep_grid("grid", {});

  const Study study = make("calibrate.lateral", grid_of("grid"));

  ASSERT_THAT(study.files, testing::ElementsAre("deviations.csv", "report.pdf"));
  std::istringstream csv(test::read_text(studies_->folder_of(study.id) / "deviations.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "index_x,index_y,column_px,row_px,deviation_x_um,deviation_y_um");
  int lines = 0;
  double first_column_px = 0.0;
  for (; std::getline(csv, line); ++lines) {
    if (lines == 0) first_column_px = std::stod(line.substr(line.find(',', line.find(',') + 1) + 1));
  }
  EXPECT_EQ(lines, figure(study, "crossings"));
  EXPECT_NEAR(first_column_px, 41.25, 0.02);
}

TEST_F(AnArtefactStudy, FindsTheDriftFromASecondHeight) {
  keep_grid("low", {});
  keep_grid("high", {3.0, -1.5, 130.0});

  const Study study = make("calibrate.lateral", grid_of("low", "high"));
  const Study back = make("calibrate.lateral", grid_of("high", "low"));

  EXPECT_NEAR(figure(study, "drift_x_px_per_um"), 0.1, 1e-3);
  EXPECT_NEAR(figure(study, "drift_y_px_per_um"), -0.05, 1e-3);
  EXPECT_NEAR(figure(back, "drift_x_px_per_um"), 0.1, 1e-3);
  EXPECT_NEAR(figure(study, "z_second_um") - figure(study, "z_first_um"), 30.0, 0.2);
  EXPECT_EQ(study.proposal->lateral->drift_px_per_um_x, figure(study, "drift_x_px_per_um"));
  EXPECT_EQ(study.proposal->lateral->drift_px_per_um_y, figure(study, "drift_y_px_per_um"));
}

TEST_F(AnArtefactStudy, KeepsAnAcceptedDriftWhereANewStudyHasNone) {
  keep_grid("low", {});
  keep_grid("high", {3.0, -1.5, 130.0});
  const Study both = make("calibrate.lateral", grid_of("low", "high"));
  const Study one = make("calibrate.lateral", grid_of("low"));

  (void)accept(both);
  const LateralConstants next = accept(one).calibration.lateral.value();

  EXPECT_EQ(next.drift_px_per_um_x, figure(both, "drift_x_px_per_um"));
  EXPECT_EQ(next.drift_px_per_um_y, figure(both, "drift_y_px_per_um"));
  EXPECT_EQ(next.origin.study, one.id);
}

TEST_F(AnArtefactStudy, RefusesADriftThatCannotBeSeen) {
  keep_grid("low", {});
  keep_grid("level", {0.0, 0.0, 100.2});
  keep_grid("undone", {0.0, 0.0, 130.0}, [](ResultData& data) {
    data.drift = DriftFigures{};
    data.drift_undone = DriftUndone::kRecipe;
  });

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.lateral", grid_of("low", "level")), HasSubstr("same height"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.lateral", grid_of("low", "undone")), HasSubstr("undone"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.lateral", grid_of("low", "low")), HasSubstr("twice"));
  EXPECT_FALSE(make("calibrate.lateral", grid_of("undone")).find("drift_x_px_per_um")->value) << "the pitch can be";
}

TEST_F(AnArtefactStudy, NeedsNoPitchToFindIt) {
  keep_grid("grid", {}, [](ResultData& data) { data.pixel_pitch_x_um = data.pixel_pitch_y_um = std::nullopt; });
  LateralRequest part = grid_of("grid");
  part.region.rectangle = PlannedRectangle{0, 0, 300, 300};

  const Study study = make("calibrate.lateral", grid_of("grid"));

  EXPECT_NEAR(figure(study, "pitch_x_um"), 0.5, 1e-5);
  EXPECT_FALSE(warns(study, "pitch_far"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.lateral", part), HasSubstr("pitch"));
}

TEST_F(AnArtefactStudy, RefusesWhatIsNoGridAndSaysWhichJob) {
  keep(surface_data("flat", [](int, int) { return 5.0; }));

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.lateral", grid_of("flat")), HasSubstr("job flat"));
  EXPECT_TRUE(kept().empty());
}

TEST_F(AnArtefactStudy, FindsTheResolutionOfAStarByDirection) {
  // Sectors of 18 pairs as a window of 9 shows them along the circle.
  keep(surface_data(
      "star",
      [](int x, int y) {
        const double radius = std::hypot(x - 159.5, y - 129.5);
        if (radius > 120.0) return 50.0;
        const double phase = 18.0 * std::atan2(y - 129.5, x - 159.5);
        const double half = 0.5 * M_PI * radius / 18.0;
        double share = 0.0;
        for (int turn = -9; turn <= 9; ++turn) {
          const double along = std::remainder(phase, 2.0 * M_PI) * radius / 18.0 + turn * 4.0 * half;
          share += boxed(along, half);
        }
        return 50.0 + 20.0 * share;
      },
      320, 260));
  ResolutionRequest request;
  request.job = "star";
  request.artefact = ResolutionRequest::kStar;

  const Study found = make("verify.resolution", request);
  request.height_um = 20.0;
  const Study told = make("verify.resolution", request);

  EXPECT_EQ(figure(found, "pairs"), 18.0);
  EXPECT_NEAR(figure(found, "width_um"), 0.75 * kWindow_px, 0.5);
  EXPECT_NEAR(figure(found, "period_um"), 1.657 * kWindow_px, 0.8);
  EXPECT_NEAR(figure(found, "width_at_0_deg_um"), 0.75 * kWindow_px, 0.7);
  EXPECT_TRUE(warns(found, "height_measured"));
  EXPECT_FALSE(warns(told, "height_measured"));
  EXPECT_FALSE(found.proposal);
}

TEST_F(AnArtefactStudy, FindsTheResolutionOfAnEdge) {
  keep(surface_data(
      "edge", [](int x, int) { return 20.0 * boxed(x - 160.0, 100.2); }, 120, 60));
  ResolutionRequest request;
  request.job = "edge";
  request.artefact = ResolutionRequest::kEdge;

  const Study study = make("verify.resolution", request);

  EXPECT_NEAR(figure(study, "width_10_90_um"), 0.8 * kWindow_px, 0.15);
  EXPECT_NEAR(figure(study, "across_deg"), 0.0, 0.5);
  EXPECT_NEAR(figure(study, "height_um"), 20.0, 0.1);
  request.pairs = 18;
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.resolution", request), HasSubstr("of a star"));
}

TEST_F(AnArtefactStudy, FindsTheProbingErrorsWhereTheFieldEndsWithinTheRim) {
  keep_cap("cap", 190.0);
  SphereRequest request;
  request.job = "cap";
  request.radius_um = 199.0;
  request.u_radius_um = 0.3;

  const Study study = make("verify.sphere", request);

  EXPECT_NEAR(figure(study, "size_error_um"), 2.0, 0.05);
  EXPECT_NEAR(study.find("size_error_um")->u.value(), 0.6, 0.01);
  EXPECT_NEAR(figure(study, "form_error_um"), 0.03 * 6.0, 0.04);
  EXPECT_NEAR(figure(study, "centre_x_um"), 90.5, 0.05);
  EXPECT_TRUE(warns(study, "slope_limit_not_reached"));
  EXPECT_FALSE(warns(study, "no_radius_uncertainty"));
  EXPECT_EQ(study.files.front(), "deviations.gsf");
}

TEST_F(AnArtefactStudy, RefusesABaseBesideTheCapAndTellsTheCircleThatKeepsItOut) {
  keep_cap("cap", 80.0);
  SphereRequest request;
  request.job = "cap";
  request.radius_um = 200.0;

  std::string why;
  try {
    (void)make("verify.sphere", request);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kStudyRefused);
    why = error.what();
  }

  StudyCircle circle;
  const auto at = why.find("circle_um x ");
  ASSERT_NE(at, std::string::npos) << why;
  ASSERT_EQ(std::sscanf(why.c_str() + at, "circle_um x %lf, y %lf, radius %lf", &circle.x_um, &circle.y_um,
                        &circle.radius_um),
            3);
  EXPECT_NEAR(circle.x_um, 90.5, 0.1);
  EXPECT_NEAR(circle.y_um, 85.5, 0.1);
  EXPECT_LT(circle.radius_um, 80.0);
  EXPECT_GT(circle.radius_um, 70.0);
  request.region.circle = circle;
  EXPECT_NEAR(figure(make("verify.sphere", request), "size_error_um"), 0.0, 0.1);
  request.region.circle->radius_um = 83.0;
  FVD_EXPECT_ERROR(kStudyRefused, make("verify.sphere", request));
  request.region.circle->radius_um = 90.0;
  FVD_EXPECT_ERROR(kRegionOutside, make("verify.sphere", request));
}

}  // namespace
}  // namespace fvd
