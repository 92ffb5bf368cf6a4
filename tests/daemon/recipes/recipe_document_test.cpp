#include "daemon/recipes/recipe_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/field_writer.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/readable_name.hpp"

namespace fvd {
namespace {

using namespace std::string_literals;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr const char* kSmallest =
    R"({"format": 2, "acquire": {"scan": {"start_um": -7, "step_um": 10, "slices": 21}}})";
constexpr const char* kSmallestOld = R"({"scan": {"start_um": -7, "step_um": 10, "slices": 21}})";

/// With more keys of "acquire", and of the document.
std::string with(const std::string& acquire, const std::string& more) {
  return R"({"format": 2, "acquire": {"scan": {"start_um": -7, "step_um": 10, "slices": 21})" + acquire + "}" + more +
         "}";
}
std::string with_camera(const std::string& camera) { return with(R"(, "camera": )" + camera, ""); }
std::string with_reconstruct(const std::string& keys) { return with("", R"(, "reconstruct": )" + keys); }
std::string with_focus(const std::string& focus) { return with_reconstruct(R"({"focus": )" + focus + "}"); }
std::string with_scan(const std::string& scan) { return R"({"format": 2, "acquire": {"scan": )" + scan + "}}"; }

/// As a document of format 2, without what is not in it.
std::string values(Recipe recipe) {
  return fields_to_json([&](Fields& fields) { describe(recipe, fields); }).dump();
}

TEST(Recipe, TakesDefaultsBeyondTheScan) {
  const Recipe recipe = parse_recipe(kSmallest, "r");

  EXPECT_EQ(recipe.id, "r");
  EXPECT_EQ(recipe.start_um, -7);
  EXPECT_EQ(recipe.slices, 21);
  EXPECT_EQ(recipe.peak, PeakMethod::kFiveSample);
  EXPECT_THAT(recipe.extra_peaks, IsEmpty());
  EXPECT_EQ(recipe.camera, CameraSettings{});
  EXPECT_EQ(recipe.focus.tests.second_peak, 0.0) << "takes memory";
}

constexpr const char* kOldWithEveryGroup = R"({
    "$schema": "../recipe.schema.json", "description": "d",
    "scan": {"start_um": 1.5, "step_um": 2.5, "slices": 9, "frame_retries": 1, "allowed_lost_slices": 2,
             "settle": {"window_um": 0.1, "samples": 5, "dwell_ms": 20, "timeout_ms": 1000}},
    "camera": {"pixel_format": "Mono12", "width_px": 640, "height_px": 480, "offset_x_px": 8, "offset_y_px": 4,
               "exposure_us": 100.5, "gain_db": 3},
    "focus": {"window_px": 5, "peak": "nearest", "extra_peaks": ["parabola", "log_parabola"], "min_prominence": 0.25},
    "lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.6},
    "result": {"min_valid_fraction": 0.75, "record_slices": true}})";

TEST(Recipe, ReadsEveryKey) {
  const Recipe recipe = parse_recipe(R"({
    "format": 2,
    "description": "d",
    "acquire": {
      "scan": {"start_um": 1.5, "step_um": 2.5, "slices": 9, "frame_retries": 1, "allowed_lost_slices": 2,
               "settle": {"window_um": 0.1, "samples": 5, "dwell_ms": 20, "timeout_ms": 1000}},
      "camera": {"pixel_format": "Mono12", "width_px": 640, "height_px": 480, "offset_x_px": 8, "offset_y_px": 4,
                 "exposure_us": 100.5, "gain_db": 3}},
    "reconstruct": {
      "focus": {"window_px": 5, "peak": "nearest", "extra_peaks": ["parabola", "log_parabola"], "min_prominence": 0.25},
      "holes": {"narrow_curve": 0.5, "second_peak": 0.75},
      "lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.6},
      "min_valid_fraction": 0.75},
    "export": ["mask.png", "height.tiff"],
    "keep": {"slices": true}})",
                                     "r");

  EXPECT_THAT(recipe.notes, IsEmpty());
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
  EXPECT_EQ(recipe.focus.tests.narrow_curve, 0.5);
  EXPECT_EQ(recipe.focus.tests.second_peak, 0.75);
  EXPECT_EQ(recipe.pixel_pitch_x_um, 0.5);
  EXPECT_EQ(recipe.pixel_pitch_y_um, 0.6);
  EXPECT_EQ(recipe.min_valid_fraction, 0.75);
  EXPECT_THAT(recipe.exports.value(), ElementsAre("mask.png", "height.tiff"));
  EXPECT_TRUE(recipe.keep_slices);
}

TEST(Recipe, NamesItsObjectiveOrNone) {
  EXPECT_EQ(parse_recipe(kSmallest, "r").objective, "");
  const Recipe recipe = parse_recipe(with(R"(, "objective": "50x")", ""), "r");
  EXPECT_EQ(recipe.objective, "50x");
  EXPECT_THAT(values(recipe), HasSubstr(R"("objective":"50x")"));
}

TEST(Recipe, TakesOneScanUnlessItSaysMore) {
  EXPECT_EQ(parse_recipe(kSmallest, "r").repeat, 1);
  EXPECT_EQ(parse_recipe(with(R"(, "repeat": 20)", R"(, "export": ["repeat_sd.tiff"])"), "r").repeat, 20);
  EXPECT_EQ(parse_recipe(with(R"(, "repeat": 1)", R"(, "keep": {"slices": true})"), "r").repeat, 1);
}

TEST(Recipe, WritesBackWhatItRead) {
  for (const std::string& text :
       {std::string(kOldWithEveryGroup), with_focus(R"({"extra_peaks": ["nearest"]})"),
        with_reconstruct(R"({"holes": {"second_peak": 0.8}})"), with("", R"(, "export": [])")}) {
    const std::string written = values(parse_recipe(text, "r"));
    EXPECT_EQ(values(parse_recipe(written, "r")), written);
  }
}

TEST(Recipe, HasTheDigestThatSha256sumTellsOfTheFile) {
  EXPECT_EQ(recipe_sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(parse_recipe(kSmallest, "a").sha256, recipe_sha256(kSmallest));
  EXPECT_NE(parse_recipe(std::string(kSmallest) + "\n", "a").sha256, recipe_sha256(kSmallest));
}

TEST(Recipe, NamesTheFilesOfFurtherMapsOnlyWhereThereAreSome) {
  const Recipe recipe =
      parse_recipe(with_reconstruct(R"({"focus": {"extra_peaks": ["nearest"]}}, "export": ["height_*.tiff"])"), "r");
  EXPECT_THAT(recipe.exports.value(), ElementsAre("height_*.tiff"));
}

TEST(OldRecipe, IsReadWithANote) {
  const Recipe old = parse_recipe(kSmallestOld, "r");
  EXPECT_EQ(values(old), values(parse_recipe(kSmallest, "r")));
  EXPECT_THAT(old.notes, ElementsAre(HasSubstr("fvdctl recipe convert")));
}

TEST(OldRecipe, NamesItsOwnPlaces) {
  FVD_EXPECT_ERROR_SAYING(
      kBadRecipe,
      (void)parse_recipe(R"({"scan": {"start_um": 0, "step_um": 1, "slices": 5}, "focus": {"window_px": 4}})", "r"),
      HasSubstr("recipe r: /focus/window_px: 4 is even"));
  FVD_EXPECT_ERROR_SAYING(kBadRecipe, (void)parse_recipe(R"({"camera": {}, "export": []})", "r"),
                          AllOf(HasSubstr("/scan: is missing"), HasSubstr("/export: unknown key")));
}

TEST(OldRecipe, IsConvertedWithAllItsValues) {
  const std::string converted = convert_recipe(kOldWithEveryGroup, "r");
  const Recipe recipe = parse_recipe(converted, "r");
  EXPECT_THAT(recipe.notes, IsEmpty());
  EXPECT_EQ(values(recipe), values(parse_recipe(kOldWithEveryGroup, "r")));
  EXPECT_THAT(converted, ::testing::StartsWith("{\n  \"$schema\": \"../recipe.schema.json\",\n  \"format\": 2"));
}

TEST(OldRecipe, KeepsItsDefaultsUnsaid) {
  EXPECT_EQ(nlohmann::json::parse(convert_recipe(std::string("// why\n") + kSmallestOld, "r")),
            nlohmann::json::parse(kSmallest));
}

TEST(OldRecipe, IsConvertedOnceOnlyAndNotWhereItIsWrong) {
  FVD_EXPECT_ERROR_SAYING(kBadRecipe, (void)convert_recipe(kSmallest, "r"), HasSubstr("nothing to convert"));
  FVD_EXPECT_ERROR_SAYING(kBadRecipe, (void)convert_recipe(R"({"scan": {}})", "r"), HasSubstr("/scan/start_um"));
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
        BadRecipe{"", "", "line 1"}, BadRecipe{"{}", "/format", "is missing"},
        BadRecipe{"{}", "/acquire", "is missing"},
        BadRecipe{R"({"format": 2, "acquire": {}})", "/acquire/scan", "is missing"},
        BadRecipe{R"({"format": 3, "acquire": {}})", "/format", "3 is not accepted; must be 2"},
        BadRecipe{R"({"format": 2, "scan": {"start_um": 0, "step_um": 1, "slices": 3}})", "/scan", "unknown key"},
        BadRecipe{with_scan(R"({"start_um": 0, "step_um": 1})"), "/acquire/scan/slices", "is missing"},
        BadRecipe{with_scan(R"({"start_um": 0, "step_um": 0, "slices": 3})"), "/acquire/scan/step_um", "above 0"},
        BadRecipe{with_scan(R"({"start_um": 0, "step_um": 1, "slices": 2})"), "/acquire/scan/slices", "3..65535"},
        BadRecipe{with_scan(R"({"start_um": 0, "step_um": 1, "slices": 5, "allowed_lost_slices": 3})"),
                  "/acquire/scan/allowed_lost_slices", "at most slices - 3, and slices is 5"},
        BadRecipe{with_scan(R"({"start_um": 0, "step_um": 1, "slices": 5, "mode": "continuous", "trigger": "line"})"),
                  "/acquire/scan/trigger", "mode step"},
        BadRecipe{with_focus(R"({"window_px": 10})"), "/reconstruct/focus/window_px", "odd"},
        BadRecipe{with_focus(R"({"window_px": 65})"), "/reconstruct/focus/window_px", "1..63"},
        BadRecipe{with_focus(R"({"window_px": 1})"), "/reconstruct/focus/window_px", "3..63"},
        BadRecipe{with_focus(R"({"distance_px": 8})"), "/reconstruct/focus/distance_px", "1..7"},
        BadRecipe{with_focus(R"({"peak": "gauss"})"), "/reconstruct/focus/peak", "\"parabola\""},
        BadRecipe{with_focus(R"({"extra_peaks": ["nearest", "nearest"]})"), "/reconstruct/focus/extra_peaks",
                  "repetitions"},
        BadRecipe{with_focus(R"({"extra_peaks": ["five_sample"]})"), "/reconstruct/focus/extra_peaks", "already"},
        BadRecipe{with_focus(R"({"min_prominence": 1.5})"), "/reconstruct/focus/min_prominence", "0..1"},
        BadRecipe{with(R"(, "objective": 50)", ""), "/acquire/objective", "expected a text"},
        BadRecipe{with(", \"objective\": \"" + std::string(65, 'x') + "\"", ""), "/acquire/objective", "64"},
        BadRecipe{with(R"(, "repeat": 0)", ""), "/acquire/repeat", "1..20"},
        BadRecipe{with(R"(, "repeat": 21)", ""), "/acquire/repeat", "1..20"},
        BadRecipe{with(R"(, "repeat": 1.5)", ""), "/acquire/repeat", "integer"},
        BadRecipe{with(R"(, "repeat": 2)", R"(, "keep": {"slices": true})"), "/acquire/repeat", "keep.slices"},
        BadRecipe{with(R"(, "repeat": 2)", R"(, "reconstruct": {"focus": {"extra_peaks": ["nearest"]}})"),
                  "/acquire/repeat", "expected 1, or no further maps"},
        BadRecipe{with("", R"(, "export": ["repeat_sd.gsf"])"), "/export", "more than 1 at /acquire/repeat"},
        BadRecipe{R"({"scan": {"start_um": 0, "step_um": 1, "slices": 3}, "objective": "50x"})", "/objective",
                  "unknown key"},
        BadRecipe{with_camera(R"({"pixel_format": "RGB8"})"), "/acquire/camera/pixel_format", "Mono8"},
        BadRecipe{with_camera(R"({"exposure_us": 0})"), "/acquire/camera/exposure_us", "above 0"},
        BadRecipe{with_camera(R"({"exposure": 1})"), "/acquire/camera/exposure", "did you mean 'exposure_us'?"},
        BadRecipe{with_reconstruct(R"({"lateral": {"pixel_pitch_x_um": -1}})"), "/reconstruct/lateral/pixel_pitch_x_um",
                  "above 0"},
        BadRecipe{with_reconstruct(R"({"holes": {"second_peak": 0.3}})"), "/reconstruct/holes/second_peak", "0.5..1"},
        BadRecipe{with_reconstruct(R"({"smooth_px": 0.5})"), "/reconstruct/smooth_px", "1..16"},
        BadRecipe{with_focus(R"({"window": "round"})"), "/reconstruct/focus/window", "double_box"},
        BadRecipe{with("", R"(, "export": ["height.tiff", "heigt.gsf"])"), "/export", "\"heigt.gsf\" is not accepted"},
        BadRecipe{with("", R"(, "export": ["height_smooth.tiff"])"), "/export", "a value at /reconstruct/smooth_px"},
        BadRecipe{with("", R"(, "export": ["height.obj"])"), "/export", "\"height.tiff\""},
        BadRecipe{with("", R"(, "export": ["height_*.tiff"])"), "/export",
                  "height_*.tiff stands for maps that the recipe does not ask for, so no file is made; expected "
                  "methods at /reconstruct/focus/extra_peaks"},
        BadRecipe{with("", R"(, "keep": {"slices": "yes"})"), "/keep/slices", "true or false"},
        BadRecipe{with("", R"(, "report": {"language": "de"})"), "/report/language", "en"},
        BadRecipe{with("", R"(, "evaluation": {"regons": {}})"), "/evaluation/regons", "unknown key"},
        BadRecipe{with("", R"(, "evaluation": {"measurements": {"s": {"kind": "step_height"}}})"),
                  "/reconstruct/lateral/pixel_pitch_y_um", "an evaluation needs the distance of the pixels"},
        BadRecipe{with(R"(, "light": {})", ""), "/acquire/light", "unknown key"},
        BadRecipe{std::string(kMaxRecipeBytes + 1, ' '), "", "at most 32768"}),
    [](const auto& of) { return test::readable_name(of.index, of.param.pointer + " " + of.param.says); });

TEST(Recipe, ReportsAllProblemsAtOnce) {
  FVD_EXPECT_ERROR_SAYING(
      kBadRecipe,
      (void)parse_recipe(R"({"format": 2, "acquire": {"scan": {"step_um": -1, "slices": 2}}, "x": 1})", "r"),
      AllOf(HasSubstr("/scan/start_um"), HasSubstr("/scan/step_um"), HasSubstr("/scan/slices"), HasSubstr("/x")));
}

TEST(Recipe, IsJudgedAsAWholeBesideProblemsOfSingleKeys) {
  FVD_EXPECT_ERROR_SAYING(
      kBadRecipe,
      (void)parse_recipe(with_scan(R"({"start_um": "x", "step_um": 1, "slices": 5, "mode": "continuous",)"
                                   R"( "trigger": "line", "allowed_lost_slices": 4})"),
                         "r"),
      AllOf(HasSubstr("/acquire/scan/start_um"), HasSubstr("/acquire/scan/trigger: line is for scan.mode step"),
            HasSubstr("/acquire/scan/allowed_lost_slices")));
  FVD_EXPECT_ERROR_SAYING(kBadRecipe,
                          (void)parse_recipe(with_focus(R"({"peak": "gauss", "extra_peaks": ["five_sample"]})"), "r"),
                          AllOf(HasSubstr("focus/peak: "), Not(HasSubstr("already"))));
}

TEST(Recipe, OfAContinuousScanNeedsASpeedThatTheStageHas) {
  for (const char* const speed : {"0", "1001"}) {
    const std::string scan = R"({"start_um": 0, "step_um": 1, "slices": 5, "mode": "continuous", "speed_um_per_s": )";
    const Problems found =
        check_stage_limits(parse_recipe(with_scan(scan + speed + "}"), "r"), {-100_um, 100_um, 20_um, 1000.0});
    ASSERT_THAT(found, SizeIs(1)) << speed;
    EXPECT_EQ(found[0].pointer, "/acquire/scan/speed_um_per_s");
    EXPECT_THAT(found[0].message, AllOf(HasSubstr(speed), HasSubstr("at most the stage's 1000 um/s")));
  }
}

TEST(Recipe, DownwardsIsForScansInSteps) {
  const std::string scan = R"({"start_um": 0, "step_um": 1, "slices": 5, "direction": "down")";
  EXPECT_TRUE(parse_recipe(with_scan(scan + "}"), "r").downwards);
  EXPECT_FALSE(parse_recipe(kSmallest, "r").downwards) << "up unless it is said";
  FVD_EXPECT_ERROR_SAYING(kBadRecipe,
                          (void)parse_recipe(with_scan(scan + R"(, "mode": "continuous", "speed_um_per_s": 5})"), "r"),
                          AllOf(HasSubstr("/acquire/scan/direction: down is for scan.mode step"), HasSubstr("lag")));
  FVD_EXPECT_ERROR_SAYING(
      kBadRecipe,
      (void)parse_recipe(with_scan(R"({"start_um": 0, "step_um": 1, "slices": 5, "direction": "left"})"), "r"),
      HasSubstr("/acquire/scan/direction"));
}

TEST(Recipe, DownwardsNeedsItsTakeUpAbove) {
  Recipe recipe = parse_recipe(kSmallest, "r");  // -7 to 193
  recipe.downwards = true;

  EXPECT_THAT(check_stage_limits(recipe, {-7_um, 213_um, 20_um, 1000.0}), IsEmpty());
  const Problems high = check_stage_limits(recipe, {-7_um, 212_um, 20_um, 1000.0});
  ASSERT_THAT(high, SizeIs(1));
  EXPECT_EQ(high[0].pointer, "/acquire/scan/slices");
  EXPECT_THAT(high[0].message, AllOf(HasSubstr("20 um of take-up"), HasSubstr("213"), HasSubstr("at most 212")));
  const Problems low = check_stage_limits(recipe, {-6_um, 213_um, 20_um, 1000.0});
  ASSERT_THAT(low, SizeIs(1));
  EXPECT_THAT(low[0].message, AllOf(HasSubstr("at least -6"), Not(HasSubstr("take-up"))));
}

TEST(Recipe, IsCheckedAgainstTheStageLimits) {
  const Recipe recipe = parse_recipe(kSmallest, "r");  // -7 to 193, with 20 of take-up from -27

  EXPECT_THAT(check_stage_limits(recipe, {-27_um, 193_um, 20_um, 1000.0}), IsEmpty());
  const Problems low = check_stage_limits(recipe, {-26_um, 193_um, 20_um, 1000.0});
  ASSERT_THAT(low, SizeIs(1));
  EXPECT_EQ(low[0].pointer, "/acquire/scan/start_um");
  EXPECT_THAT(low[0].message, AllOf(HasSubstr("-27"), HasSubstr("at least -6 um")));
  const Problems high = check_stage_limits(recipe, {-27_um, 192_um, 20_um, 1000.0});
  ASSERT_THAT(high, SizeIs(1));
  EXPECT_EQ(high[0].pointer, "/acquire/scan/slices");
  EXPECT_THAT(high[0].message, AllOf(HasSubstr("193"), HasSubstr("at most 192")));
  EXPECT_THAT(check_stage_limits(recipe, {0_um, 1_um, 20_um, 1000.0}), SizeIs(2));
  EXPECT_THAT(check_stage_limits(recipe, {0_um, 1_um, 20_um, 1000.0}, {{"/acquire/scan/step_um", "is missing"}}),
              SizeIs(1));
  EXPECT_THAT(check_stage_limits(recipe, {0_um, 1_um, 20_um, 1000.0}, {{"/acquire/scan/start_um", "is missing"}}),
              IsEmpty());
}

TEST(Recipe, OfFormat1IsToldWhereItsOwnTextLeavesTheStageLimits) {
  const Recipe recipe = parse_recipe(kSmallestOld, "r");
  EXPECT_EQ(recipe.format, 1);
  const Problems found = check_stage_limits(recipe, {0_um, 1_um, 20_um, 1000.0});
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].pointer, "/scan/start_um");
  EXPECT_EQ(found[1].pointer, "/scan/slices");
  EXPECT_THAT(check_stage_limits(recipe, {0_um, 1_um, 20_um, 1000.0}, {{"/scan/start_um", "is missing"}}), IsEmpty());
}

TEST(RecipeId, IsAPlainName) {
  EXPECT_TRUE(is_recipe_id("chapter"));
  EXPECT_TRUE(is_recipe_id("A-b_9"));
  EXPECT_TRUE(is_recipe_id(std::string(32, 'x')));
  EXPECT_FALSE(is_recipe_id(std::string(33, 'x')));
  for (const std::string id : {"", ".", "..", "a/b", "../a", "/etc/passwd", "a.json", "a b", "a\n", "\xc3\xa9"}) {
    EXPECT_FALSE(is_recipe_id(id)) << id;
  }
  for (const std::string& id : {"a\0"s, "a\0b"s, "\0a"s, "\0"s}) EXPECT_FALSE(is_recipe_id(id)) << "NUL within";
  EXPECT_EQ("a\0"s.size(), 2U) << "the text above holds a NUL";
}

}  // namespace
}  // namespace fvd
