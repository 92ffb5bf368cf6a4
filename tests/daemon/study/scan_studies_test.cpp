/// Hysteresis of two jobs, the reproducibility of texture, and jobs evaluated anew with a reference map.

#include <gmock/gmock.h>

#include "daemon/export/gsf.hpp"
#include "tests/daemon/study/study_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

class AScanStudy : public test::AStudyDesk {
 protected:
  void keep_scan(const std::string& id, bool downwards, double lift_um, double tilt) {
    ResultData data =
        surface_data(id, [&](int x, int y) { return 0.3 * ((x + 2 * y) % 5) + lift_um + tilt * (x + 0.5); });
    data.focus.window_px = 1;
    data.focus.focus_operator = FocusOperator::kIntensity;
    if (downwards) {
      std::reverse(data.steps.begin(), data.steps.end());
      data.step_summary.error_mean_um = -0.02;
    }
    keep(data);
  }
  static TextureRequest texture_of(const std::vector<std::string>& jobs) {
    TextureRequest request;
    request.jobs = jobs;
    request.what = {"step", "height_um"};
    return request;
  }
  std::vector<std::string> know_values(const std::vector<double>& values) {
    std::vector<std::string> ids;
    for (const double value : values) {
      ids.push_back("t" + std::to_string(ids.size()));
      know_value(ids.back(), value, 0.01);
    }
    return ids;
  }
};

TEST_F(AScanStudy, FindsWhatAScanDownwardsSeesOtherwise) {
  keep_scan("up", false, 0.0, 0.0);
  keep_scan("down", true, 0.5, 0.001);

  const Study study = make("verify.hysteresis", HysteresisRequest{"up", "down", {}});

  EXPECT_NEAR(figure(study, "mean_um"), 0.5 + 0.001 * kWidth / 2.0, 1e-4);
  EXPECT_NEAR(figure(study, "slope_x_um_per_mm"), 1.0, 1e-3);
  EXPECT_NEAR(figure(study, "slope_y_um_per_mm"), 0.0, 1e-3);
  EXPECT_NEAR(figure(study, "rest_um"), 0.0, 1e-4);
  EXPECT_NEAR(figure(study, "stage_difference_um"), -0.02 - 0.0625, 1e-9);
  EXPECT_TRUE(warns(study, "hysteresis"));
  EXPECT_FALSE(warns(study, "recipes_differ"));
  EXPECT_EQ(study.files.front(), "difference.gsf");
}

TEST_F(AScanStudy, RefusesScansOfTheWrongDirection) {
  keep_scan("up", false, 0.0, 0.0);
  keep_scan("again", false, 0.5, 0.0);
  keep_scan("down", true, 0.5, 0.0);

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.hysteresis", HysteresisRequest{"up", "again", {}}),
                          HasSubstr("job again was not scanned downwards"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.hysteresis", HysteresisRequest{"down", "down", {}}),
                          HasSubstr("twice"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("verify.hysteresis", HysteresisRequest{"down", "up", {}}),
                          HasSubstr("job down was not scanned upwards"));
}

TEST_F(AScanStudy, FindsTheReproducibilityOfTextureAndProposesIt) {
  const auto ids = know_values({1.02, 0.98, 1.0, 1.04, 0.96});

  const Study verified = make("verify.texture", texture_of(ids));
  const Study proposed = make("calibrate.texture", texture_of(ids));

  const double expected = 100.0 * std::sqrt(0.004 / 4.0);
  EXPECT_NEAR(figure(verified, "reproducibility_percent"), expected, 1e-9);
  EXPECT_NEAR(verified.find("reproducibility_percent")->u.value(), expected / std::sqrt(8.0), 1e-9);
  EXPECT_NEAR(figure(verified, "mean"), 1.0, 1e-12);
  EXPECT_FALSE(verified.proposal);
  EXPECT_TRUE(warns(verified, "few_scans"));
  ASSERT_TRUE(proposed.proposal && proposed.proposal->texture);
  EXPECT_NEAR(proposed.proposal->texture->reproducibility_percent, expected, 1e-9);
  const auto accepted = desk_->accept({proposed.id, "anna", "", "2099-01-01", std::nullopt}, "2026-11-29");
  EXPECT_EQ(accepted.calibration.texture.value().origin.study, proposed.id);
}

TEST_F(AScanStudy, RefusesAReproducibilityThatSaysNothing) {
  const auto ids = know_values({0.1, -0.1, 0.05});

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.texture", texture_of(ids)), HasSubstr("near to 0"));
  FVD_EXPECT_ERROR(kStudyRefused, make("calibrate.texture", texture_of({"t0"})));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.texture", texture_of({"t0", "t0"})), HasSubstr("twice"));
}

/// A recipe that takes the reference map off, and the texture of what is left.
constexpr const char* kFlattened = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}},
  "evaluation": {"surfaces": {"s": {"steps": [{"op": "flatness_reference"}, {"op": "level"}]}},
                 "measurements": {"t": {"kind": "areal", "surface": "s", "parameters": ["Sq"]}}}})";

TEST_F(AScanStudy, EvaluatesAnewWithTheReferenceMapOfTheConstants) {
  // A bow of 5 um that the instrument makes, and 0.5 um that are the part's.
  const auto bow_um = [](int x) { return 5.0 * std::pow((x - 29.5) / 29.5, 2); };
  Plane<float> map_um(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) map_um.at(x, y) = static_cast<float>(bow_um(x));
  }
  calibrations_->add("", [&](Calibration& next) {
    next.flatness = FlatnessConstants{5.0, 0.001, next.id + "-flatness.gsf", {}};
    return std::vector<CalibrationFile>{{next.flatness->reference, gsf_of_um(map_um, 1.0, 1.0, "flat")}};
  });
  for (const std::string id : {"a", "b"}) {
    ResultData data = surface_data(id, [&](int x, int y) { return bow_um(x) + ((x + y) % 2 == 0 ? 0.5 : -0.5); });
    data.calibration = calibrations_->current("");
    keep(data);
  }
  recipes_["flattened"] = kFlattened;
  TextureRequest request;
  request.jobs = {"a", "b"};
  request.what = {"t", "Sq_um"};
  request.recipe = "flattened";

  const Study study = make("verify.texture", request);

  EXPECT_NEAR(figure(study, "mean"), 0.5, 0.005);
  std::filesystem::remove(calibrations_->folder() / "cal-0001-flatness.gsf");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, make("verify.texture", request), HasSubstr("cal-0001-flatness.gsf"));
}

}  // namespace
}  // namespace fvd
