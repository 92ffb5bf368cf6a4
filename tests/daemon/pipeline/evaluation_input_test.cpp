/// What an evaluation knows, from a job's data and from the folder of its result: the same.

#include "daemon/pipeline/evaluation_input.hpp"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/gsf.hpp"
#include "daemon/export/mask_png.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/step_csv.hpp"
#include "daemon/result/evaluate.hpp"
#include "daemon/surface_files/reference_map.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "tests/daemon/calibration/some_calibration.hpp"
#include "tests/daemon/evaluation/planned.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;
using ::testing::IsEmpty;

constexpr const char* kPlan = R"({"expansion_per_k": 11.5e-6,
  "surfaces": {"s": {"steps": [{"op": "mask_reasons", "reasons": ["saturated"]}, {"op": "flatness_reference"},
                               {"op": "lateral"}, {"op": "level"}]}},
  "measurements": {"t": {"kind": "areal", "surface": "s", "parameters": ["Sq", "Sz", "Sdq"],
                         "limits": {"Sdq": {"upper": 9}}}}})";

/// A calibration's folder with a reference map for 40 x 30 points.
void write_reference(const std::filesystem::path& folder) {
  Plane<float> heights(40, 30);
  Plane<float> errors(40, 30, 1.3e-8F);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) heights.at(x, y) = 1e-8F * static_cast<float>((x * 7 + y * 3) % 11);
  }
  std::filesystem::create_directories(folder);
  test::write_text(folder / "cal-0003-flatness.gsf", encode_gsf(heights, {"flat", 0.5, 0.5, {}}));
  test::write_text(folder / "cal-0003-flatness-sigma.gsf", encode_gsf(errors, {"flat", 0.5, 0.5, {}}));
}

/// The files of a result that an evaluation reads.
void write_files(const std::filesystem::path& folder, const ResultData& data) {
  std::filesystem::create_directories(folder);
  const GsfHeader header{"job", data.pixel_pitch_x_um, data.pixel_pitch_y_um, {}};
  test::write_text(folder / "height.gsf", encode_gsf(data.map.height_m, header));
  test::write_text(folder / "sigma.gsf", encode_gsf(data.map.sigma_m, header));
  test::write_text(folder / "mask.png", encode_mask_png(data.map));
  test::write_text(folder / "step_log.csv", step_csv(data.steps));
  test::write_text(folder / "result.json", result_json_text(evaluate(data, test::summary_of(data.map))));
}

ResultData calibrated_job(const std::filesystem::path& calibration_folder) {
  ResultData data = test::sample_result();
  data.map = test::sample_map(40, 30);
  test::make_hole(data.map, 5, 5, mask_reason::kSaturated);
  data.pixel_pitch_x_um = data.pixel_pitch_y_um = 0.5;
  data.encoder_resolution_um = 0.1;
  data.objective = "10x";
  data.temperature = Temperature{23.456789, "job", 0.125};
  data.calibration = test::whole_calibration();
  data.calibration->z->alpha_z = 1.0 + 1.0 / 3.0;
  data.calibration->lateral->shear = 0.003;
  data.repeatability = {{"t.Sq_um", {1.0 / 3.0, 24.0, "study-0007"}}};
  data.flatness_reference = read_reference_map(calibration_folder, data.calibration->flatness->reference);
  return data;
}

Evaluation evaluated(const Surface& surface, const EvaluationContext& context) {
  Problems problems;
  const EvaluationPlan plan = test::read_plan(kPlan, problems);
  EXPECT_THAT(problems, IsEmpty());
  return evaluate_surface(surface, plan, context, nullptr);
}

TEST(EvaluationInput, IsTheSameFromTheFolderOfAResult) {
  const ScratchDir scratch;
  write_reference(scratch / "calibration");
  const ResultData data = calibrated_job(scratch / "calibration");
  write_files(scratch / "job", data);

  ResultSurface read = read_result_surface(scratch / "job");
  note_window(read.result.focus, read.surface);
  EvaluationContext context = read_evaluation_context(scratch / "job", read.result);
  context.flatness_reference =
      read_reference_map(scratch / "calibration", context.calibration.value().flatness.value().reference);

  const EvaluationContext online = evaluation_context(data);
  EXPECT_EQ(context.samples, online.samples);
  EXPECT_EQ(context.calibration, online.calibration);
  EXPECT_EQ(context.temperature_c, online.temperature_c);
  EXPECT_EQ(context.repeatability, online.repeatability);
  const Evaluation again = evaluated(read.surface, context);
  EXPECT_EQ(again.measurements.at("t").reason, "");
  EXPECT_EQ(again.measurements.at("t").values.at("Sq_um").budget.size(), 5U);
  EXPECT_EQ(again, evaluated(evaluated_surface(data), online));
}

TEST(EvaluationInput, OfAResultWithoutConstantsHasNone) {
  const ScratchDir scratch;
  const ResultData data = test::sample_result();
  write_files(scratch / "job", data);

  const EvaluationContext context =
      read_evaluation_context(scratch / "job", read_result_surface(scratch / "job").result);

  EXPECT_FALSE(context.calibration);
  EXPECT_FALSE(context.temperature_c);
  EXPECT_TRUE(context.repeatability.empty());
}

}  // namespace
}  // namespace fvd
