#include "daemon/recipes/recipe_book.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/field_writer.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/readable_name.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using namespace std::string_literals;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kSmallest = R"({"scan": {"start_um": -7, "step_um": 10, "slices": 21}})";

std::string with_scan(const std::string& more) {
  return R"({"scan": {"start_um": -7, "step_um": 10, "slices": 21}, )" + more + "}";
}

TEST(Recipe, TakesDefaultsBeyondTheScan) {
  const Recipe recipe = parse_recipe(kSmallest, "r");

  EXPECT_EQ(recipe.id, "r");
  EXPECT_EQ(recipe.start_um, -7);
  EXPECT_EQ(recipe.slices, 21);
  EXPECT_EQ(recipe.peak, PeakMethod::kFiveSample);
  EXPECT_THAT(recipe.extra_peaks, IsEmpty());
  EXPECT_EQ(recipe.camera, CameraSettings{});
}

TEST(Recipe, ReadsEveryKey) {
  const Recipe recipe = parse_recipe(R"({
    "description": "d",
    "scan": {"start_um": 1.5, "step_um": 2.5, "slices": 9, "frame_retries": 1, "allowed_lost_slices": 2,
             "settle": {"window_um": 0.1, "samples": 5, "dwell_ms": 20, "timeout_ms": 1000}},
    "camera": {"pixel_format": "Mono12", "width_px": 640, "height_px": 480, "offset_x_px": 8, "offset_y_px": 4,
               "exposure_us": 100.5, "gain_db": 3},
    "focus": {"window_px": 5, "peak": "nearest", "extra_peaks": ["parabola", "log_parabola"], "min_prominence": 0.25},
    "lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.6},
    "result": {"min_valid_fraction": 0.75, "record_slices": true}})",
                                     "r");

  EXPECT_EQ(recipe.description, "d");
  EXPECT_EQ(recipe.start_um, 1.5);
  EXPECT_EQ(recipe.step_um, 2.5);
  EXPECT_EQ(recipe.slices, 9);
  EXPECT_EQ(recipe.frame_retries, 1);
  EXPECT_EQ(recipe.allowed_lost_slices, 2);
  EXPECT_EQ(recipe.settle.window, Micrometers{0.1});
  EXPECT_EQ(recipe.settle.samples, 5);
  EXPECT_EQ(recipe.settle.dwell.count(), 20);
  EXPECT_EQ(recipe.settle.timeout.count(), 1000);
  EXPECT_EQ(recipe.camera.pixel_format, SensorFormat::kMono12);
  EXPECT_EQ(recipe.camera.width, 640);
  EXPECT_EQ(recipe.camera.height, 480);
  EXPECT_EQ(recipe.camera.offset_x, 8);
  EXPECT_EQ(recipe.camera.offset_y, 4);
  EXPECT_EQ(recipe.camera.exposure_us, 100.5);
  EXPECT_EQ(recipe.camera.gain_db, 3);
  EXPECT_EQ(recipe.focus.window_px, 5);
  EXPECT_EQ(recipe.peak, PeakMethod::kNearest);
  EXPECT_THAT(recipe.extra_peaks, ElementsAre(PeakMethod::kParabola, PeakMethod::kLogParabola));
  EXPECT_EQ(recipe.focus.min_prominence, 0.25);
  EXPECT_EQ(recipe.pixel_pitch_x_um, 0.5);
  EXPECT_EQ(recipe.pixel_pitch_y_um, 0.6);
  EXPECT_EQ(recipe.min_valid_fraction, 0.75);
  EXPECT_TRUE(recipe.record_slices);
}

TEST(Recipe, WritesBackWhatItRead) {
  Recipe recipe = parse_recipe(with_scan(R"("focus": {"extra_peaks": ["nearest"]}, "camera": {"gain_db": 1.5})"), "r");
  const auto text = fields_to_json([&](Fields& fields) { describe(recipe, fields); }).dump();
  EXPECT_EQ(parse_recipe(text, "r").sha256, recipe.sha256);
}

TEST(Recipe, HasADigestOfItsValuesNotOfItsLayout) {
  const std::string digest = parse_recipe(kSmallest, "a").sha256;

  EXPECT_THAT(digest, ::testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_THAT(digest, SizeIs(64));
  EXPECT_EQ(parse_recipe(with_scan(R"("focus": {"window_px": 9})"), "b").sha256, digest) << "a default spelled out";
  EXPECT_EQ(parse_recipe(std::string("// why\n") + kSmallest, "c").sha256, digest);
  EXPECT_NE(parse_recipe(with_scan(R"("focus": {"window_px": 11})"), "a").sha256, digest);
}

struct BadRecipe {
  std::string text;
  std::string pointer;
  std::string says;
};

/// For the names of the tests.
void PrintTo(const BadRecipe& of, std::ostream* out) { *out << of.pointer << ": " << of.says; }

class ABadRecipe : public ::testing::TestWithParam<BadRecipe> {};

TEST_P(ABadRecipe, IsRefusedWithPointerAndReason) {
  FVD_EXPECT_ERROR_SAYING(kBadRecipe, (void)parse_recipe(GetParam().text, "r"),
                          AllOf(HasSubstr("recipe r: " + GetParam().pointer), HasSubstr(GetParam().says)));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ABadRecipe,
    ::testing::Values(
        BadRecipe{"", "", "line 1"}, BadRecipe{"{}", "/scan", "is missing"},
        BadRecipe{R"({"scan": {"start_um": 0, "step_um": 1}})", "/scan/slices", "is missing"},
        BadRecipe{R"({"scan": {"start_um": 0, "step_um": 0, "slices": 3}})", "/scan/step_um", "above 0"},
        BadRecipe{R"({"scan": {"start_um": 0, "step_um": 1, "slices": 2}})", "/scan/slices", "3..65535"},
        BadRecipe{R"({"scan": {"start_um": 0, "step_um": 1, "slices": 5, "allowed_lost_slices": 3}})",
                  "/scan/allowed_lost_slices", "at most 2"},
        BadRecipe{with_scan(R"("focus": {"window_px": 10})"), "/focus/window_px", "odd"},
        BadRecipe{with_scan(R"("focus": {"window_px": 65})"), "/focus/window_px", "3..63"},
        BadRecipe{with_scan(R"("focus": {"distance_px": 8})"), "/focus/distance_px", "1..7"},
        BadRecipe{with_scan(R"("focus": {"peak": "gauss"})"), "/focus/peak", "\"parabola\""},
        BadRecipe{with_scan(R"("focus": {"extra_peaks": ["nearest", "nearest"]})"), "/focus/extra_peaks",
                  "repetitions"},
        BadRecipe{with_scan(R"("focus": {"extra_peaks": ["five_sample"]})"), "/focus/extra_peaks", "already"},
        BadRecipe{with_scan(R"("focus": {"min_prominence": 1.5})"), "/focus/min_prominence", "0..1"},
        BadRecipe{with_scan(R"("camera": {"pixel_format": "RGB8"})"), "/camera/pixel_format", "Mono8"},
        BadRecipe{with_scan(R"("camera": {"exposure_us": 0})"), "/camera/exposure_us", "above 0"},
        BadRecipe{with_scan(R"("camera": {"exposure": 1})"), "/camera/exposure", "did you mean 'exposure_us'?"},
        BadRecipe{with_scan(R"("lateral": {"pixel_pitch_x_um": -1})"), "/lateral/pixel_pitch_x_um", "above 0"},
        BadRecipe{with_scan(R"("result": {"record_slices": "yes"})"), "/result/record_slices", "true or false"},
        BadRecipe{with_scan(R"("speed": 1)"), "/speed", "unknown key"}),
    [](const auto& of) { return test::readable_name(of.index, of.param.pointer + " " + of.param.says); });

TEST(Recipe, ReportsAllProblemsAtOnce) {
  FVD_EXPECT_ERROR_SAYING(
      kBadRecipe, (void)parse_recipe(R"({"scan": {"step_um": -1, "slices": 2}, "x": 1})", "r"),
      AllOf(HasSubstr("/scan/start_um"), HasSubstr("/scan/step_um"), HasSubstr("/scan/slices"), HasSubstr("/x")));
}

TEST(Recipe, IsCheckedAgainstTheStageLimits) {
  const Recipe recipe = parse_recipe(kSmallest, "r");  // -7 to 193, with 20 of take-up from -27

  EXPECT_THAT(check_stage_limits(recipe, -27_um, 193_um, 20_um), IsEmpty());
  const Problems low = check_stage_limits(recipe, -26_um, 193_um, 20_um);
  ASSERT_THAT(low, SizeIs(1));
  EXPECT_EQ(low[0].pointer, "/scan/start_um");
  EXPECT_THAT(low[0].message, AllOf(HasSubstr("-27"), HasSubstr("at least -6 um")));
  const Problems high = check_stage_limits(recipe, -27_um, 192_um, 20_um);
  ASSERT_THAT(high, SizeIs(1));
  EXPECT_EQ(high[0].pointer, "/scan/slices");
  EXPECT_THAT(high[0].message, AllOf(HasSubstr("193"), HasSubstr("at most 192")));
  EXPECT_THAT(check_stage_limits(recipe, 0_um, 1_um, 20_um), SizeIs(2));
}

TEST(RecipeId, IsAPlainName) {
  EXPECT_TRUE(is_recipe_id("chapter"));
  EXPECT_TRUE(is_recipe_id("A-b_9"));
  EXPECT_TRUE(is_recipe_id(std::string(32, 'x')));
  EXPECT_FALSE(is_recipe_id(std::string(33, 'x')));
  for (const std::string id : {"", ".", "..", "a/b", "../a", "/etc/passwd", "a.json", "a b", "a\n", "\xc3\xa9"}) {
    EXPECT_FALSE(is_recipe_id(id)) << id;
  }
  EXPECT_FALSE(is_recipe_id(std::string("a\0b", 3)));
}

class ARecipeFolder : public ::testing::Test {
 protected:
  void put(const std::string& name, const std::string& text = kSmallest) {
    std::ofstream(folder_.path() / name) << text;
  }
  test::ScratchDir folder_;
};

TEST_F(ARecipeFolder, ListsItsRecipesSorted) {
  put("b.json");
  put("a.json");
  put("notes.txt");
  put("not an id.json");
  put(".json");
  std::filesystem::create_directory(folder_.path() / "folder.json");
  EXPECT_THAT(list_recipes(folder_.path()), ElementsAre("a", "b"));
}

TEST_F(ARecipeFolder, MustExistToBeListed) {
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)list_recipes(folder_.path() / "absent"), HasSubstr("absent"));
}

TEST_F(ARecipeFolder, LoadsARecipe) {
  put("a.json");
  EXPECT_EQ(load_recipe(folder_.path(), "a").slices, 21);
  EXPECT_EQ(recipe_text(folder_.path(), "a"), kSmallest);
}

TEST_F(ARecipeFolder, NamesTheKnownRecipesWhenOneIsUnknown) {
  put("a.json");
  put("b.json");
  FVD_EXPECT_ERROR_SAYING(kUnknownRecipe, (void)load_recipe(folder_.path(), "c"), HasSubstr("a, b"));
}

TEST_F(ARecipeFolder, DoesNotLeaveItself) {
  put("a.json");
  std::filesystem::create_directory(folder_.path() / "inner");
  put("inner/a.json");  // what "a\0" would open
  for (const std::string& id : {"../a"s, "inner/../a"s, ""s, "."s, ".."s, "a.json"s, "a\0"s}) {
    FVD_EXPECT_ERROR(kUnknownRecipe, (void)load_recipe(folder_.path() / "inner", id));
  }
}

TEST_F(ARecipeFolder, NamesTheRecipeThatIsBad) {
  put("bad.json", "{");
  FVD_EXPECT_ERROR_SAYING(kBadRecipe, (void)load_recipe(folder_.path(), "bad"), HasSubstr("recipe bad"));
}

}  // namespace
}  // namespace fvd
