/// Regions that are pictures: read beside the recipe, refused with file and reason, told with their digest.

#include "daemon/recipes/recipe_masks.hpp"

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/evaluation/field_check.hpp"
#include "daemon/recipes/recipe_book.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/config/read_fields.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::problem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string recipe_with(const std::string& mask) {
  return R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 1, "slices": 11}},
    "reconstruct": {"lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}},
    "evaluation": {
      "regions": {"land": {"mask_png": ")" +
         mask + R"("}},
      "surfaces": {"flat": {"steps": [{"op": "level", "regions": ["land"]}]}},
      "measurements": {"part": {"kind": "areal", "region": "land", "parameters": ["Sa"]},
                       "flat": {"kind": "areal", "surface": "flat", "parameters": ["Sa"]},
                       "all": {"kind": "areal", "parameters": ["Sa"]}}}})";
}

/// Heights of 1 um in the left half, 3 um in the right.
Surface two_levels(int width = 8, int height = 6) {
  Surface surface;
  surface.height_m = Plane<float>(width, height, 1e-6F);
  for (int row = 0; row < height; ++row) {
    for (int column = width / 2; column < width; ++column) surface.height_m.at(column, row) = 3e-6F;
  }
  surface.pitch_x_um = surface.pitch_y_um = 1.0;
  return surface;
}

class AMask : public testing::Test {
 protected:
  AMask() {
    std::filesystem::create_directory(folder_ / "masks");
    cv::Mat left(6, 8, CV_8UC1, cv::Scalar(0));
    left(cv::Rect(0, 0, 4, 6)) = 200;
    left.at<unsigned char>(5, 0) = 1;
    put("left.png", left);
  }
  void put(const std::string& name, const cv::Mat& image) const { cv::imwrite((masks() / name).string(), image); }
  [[nodiscard]] std::filesystem::path masks() const { return folder_ / "masks"; }

  [[nodiscard]] Problems problems_of(const std::string& mask) const {
    Problems problems;
    Recipe recipe = read_recipe(recipe_with(mask), "part", problems);
    read_masks(folder_.path(), recipe.evaluation, problems);
    return problems;
  }
  [[nodiscard]] EvaluationPlan plan() const {
    test::write_text(folder_ / "part.json", recipe_with("left.png"));
    return read_recipe_file(folder_ / "part.json").evaluation;
  }

  test::ScratchDir folder_;
};

TEST_F(AMask, IsTheRegionOfItsPointsThatAreNotZero) {
  const Evaluation made = evaluate_surface(two_levels(), plan(), {}, nullptr);

  const EvaluatedMeasurement& part = made.measurements.at("part");
  EXPECT_EQ(part.points, 24);
  EXPECT_NEAR(part.values.at("Sa_um").value.value_or(-1.0), 0.0, 1e-6);  // of both halves it is 1
}

TEST_F(AMask, IsToldWithTheDigestOfItsFile) {
  const Evaluation made = evaluate_surface(two_levels(), plan(), {}, nullptr);

  const std::string sha256 = recipe_sha256(test::read_text(masks() / "left.png"));
  for (const char* name : {"part", "flat"}) {
    EXPECT_THAT(made.measurements.at(name).details, HasSubstr(R"("mask_sha256":{"left.png":")" + sha256 + "\"}"));
  }
  EXPECT_THAT(made.measurements.at("all").details, Not(HasSubstr("mask_sha256")));
}

TEST_F(AMask, OfAnotherSizeMakesNoMeasurementAndSaysBoth) {
  const Evaluation made = evaluate_surface(two_levels(9, 6), plan(), {}, nullptr);

  EXPECT_THAT(made.measurements.at("part").reason, HasSubstr("left.png has 8 x 6 points, the surface has 9 x 6"));
  EXPECT_THAT(made.measurements.at("flat").reason, HasSubstr("left.png has 8 x 6 points, the surface has 9 x 6"));
  EXPECT_THAT(outside_field(plan(), {9, 6, 1.0, 1.0}, "/evaluation"),
              ElementsAre(problem("/evaluation/regions/land/mask_png", "8 x 6 points, the surface has 9 x 6")));
  EXPECT_THAT(outside_field(plan(), {8, 6, 1.0, 1.0}, "/evaluation"), IsEmpty());
}

TEST_F(AMask, IsRefusedWithItsFileAndTheReason) {
  put("colour.png", cv::Mat(6, 8, CV_8UC3, cv::Scalar(1, 2, 3)));
  put("deep.png", cv::Mat(6, 8, CV_16UC1, cv::Scalar(1)));
  put("black.png", cv::Mat(6, 8, CV_8UC1, cv::Scalar(0)));
  test::write_text(masks() / "text.png", "no picture at all, but long enough");
  test::write_text(masks() / "empty.png", "");
  const std::string whole = test::read_text(masks() / "left.png");
  test::write_text(masks() / "cut.png", whole.substr(0, whole.size() / 2));
  std::string huge = whole;
  huge[16] = huge[20] = 0x7F;  // sides above 2^30
  test::write_text(masks() / "huge.png", huge);
  std::filesystem::create_directory(masks() / "folder.png");

  const auto refusal = [](const char* why) { return ElementsAre(problem("/evaluation/regions/land/mask_png", why)); };
  EXPECT_THAT(problems_of("left.png"), IsEmpty());
  EXPECT_THAT(problems_of("missing.png"), refusal("masks/missing.png: there is no such file; expected a PNG of 8 bit"));
  EXPECT_THAT(problems_of("colour.png"), refusal("3 channel(s) of 8 bit"));
  EXPECT_THAT(problems_of("deep.png"), refusal("1 channel(s) of 16 bit"));
  EXPECT_THAT(problems_of("black.png"), refusal("the region is empty"));
  EXPECT_THAT(problems_of("text.png"), refusal("it is no PNG"));
  EXPECT_THAT(problems_of("empty.png"), refusal("is empty"));
  EXPECT_THAT(problems_of("cut.png"), refusal("masks/cut.png"));
  EXPECT_THAT(problems_of("huge.png"), refusal("above 2^26 points"));
  EXPECT_THAT(problems_of("folder.png"), refusal("there is no such file"));
}

TEST_F(AMask, IsNeverReadFromAnotherFolder) {
  for (const char* name : {"../left.png", "/etc/x.png", "a/b.png", ".hidden.png", "left.PNG", "left", ".png", ""}) {
    EXPECT_THAT(problems_of(name), ElementsAre(problem("/evaluation/regions/land/mask_png", "without a path"))) << name;
  }
}

TEST_F(AMask, OfAnEditedRecipeStandsBesideTheShippedOnes) {
  JobStore store(folder_ / "fvd.sqlite");
  RecipeBook book({folder_.path(), folder_ / "edited"}, {Micrometers{-10}, Micrometers{100}, Micrometers{5}, 1000.0},
                  store.recipe_versions());

  EXPECT_EQ(book.save({"part", recipe_with("left.png"), 0, "anna", ""}), 1);
  EXPECT_EQ(book.load("part").evaluation.masks.size(), 1U);
  EXPECT_THAT(book.check(recipe_with("gone.png"), "part").refusal, HasSubstr("masks/gone.png"));
  FVD_EXPECT_ERROR(kBadRecipe, book.save({"part", recipe_with("gone.png"), 1, "anna", ""}));

  std::filesystem::remove(masks() / "left.png");
  FVD_EXPECT_ERROR(kBadRecipe, static_cast<void>(book.load("part")));
}

}  // namespace
}  // namespace fvd
