/// A recipe that measures: from the PLC's trigger to its verdict, and the same values from the result's folder.

#include "config/field_writer.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/pipeline/evaluation_input.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

/// The step from plateau A to B of the chapter's scene, between regions of this size, with these limits.
std::string recipe_of(const std::string& upper_region, const std::string& limits) {
  return R"({"format": 2, "acquire": {"scan": {"start_um": -7, "step_um": 10, "slices": 21},
      "camera": {"exposure_us": 2000}},
    "reconstruct": {"focus": {"curve_width_um": 28}, "lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}},
    "evaluation": {
      "surfaces": {"level": {"steps": [{"op": "outliers"}]}},
      "regions": {"a": {"rectangle_um": {"x": 20, "y": 20, "width": 80, "height": 300}}, "b": )" +
         upper_region + R"(},
      "measurements": {
        "step": {"kind": "step_between", "surface": "level", "lower": "a", "upper": "b", "slope": "from_lower",
                 "limits": {"height_um": )" +
         limits + R"(}},
        "land": {"kind": "areal", "surface": "level", "region": "a", "parameters": ["Sa", "Sq"]},
        "line": {"kind": "profile", "from_um": [10, 30], "to_um": [110, 30], "parameters": ["Ra"], "nesting_um": 20}}}})";
}

/// Every number and text; the order of keys, which details lose when they are read, is not looked at.
json values_of(Evaluation evaluation) {
  return json::parse(fields_to_json([&](Fields& fields) { describe(evaluation, fields); }).dump());
}

constexpr const char* kPlateauB = R"({"rectangle_um": {"x": 130, "y": 20, "width": 90, "height": 60}})";
constexpr const char* kFewPoints = R"({"rectangle_um": {"x": 150, "y": 40, "width": 4, "height": 4}})";
constexpr const char* kTexturePoor = R"({"rectangle_um": {"x": 155, "y": 130, "width": 50, "height": 90}})";

class AMeasuringMicroscope : public AMicroscope {
 protected:
  void start_with_recipes() {
    test::write_text(recipes_.path() / "good.json", recipe_of(kPlateauB, R"({"lower": 49.5, "upper": 50.5})"));
    test::write_text(recipes_.path() / "bad.json", recipe_of(kPlateauB, R"({"lower": 40, "upper": 45})"));
    test::write_text(recipes_.path() / "unsure.json", recipe_of(kFewPoints, R"({"lower": 49.9, "upper": 50.1})"));
    test::write_text(recipes_.path() / "none.json", recipe_of(kTexturePoor, R"({"lower": 40, "upper": 60})"));
    start();
    app_.reset();
    config_.paths.recipe_dir = recipes_.path();
    app_ = std::make_unique<App>(config_);
    ASSERT_TRUE(wait_until_ready());
  }

  test::ScratchDir recipes_;
};

TEST_F(AMeasuringMicroscope, TellsAPlcEveryVerdictInFewBytes) {
  start_with_recipes();
  const std::vector<std::pair<std::string, std::string>> expected{
      {"good", "pass"}, {"bad", "fail"}, {"unsure", "uncertain"}, {"none", "invalid"}};
  std::int64_t seq = 0;
  for (const auto& [recipe, verdict] : expected) {
    begin(++seq, recipe);
    const json ended = await_end(seq);
    ASSERT_EQ(ended["state"], "completed") << "a bad part is no failed job: " << ended.dump();
    LineClient client(app_->rpc_port());
    const std::string line =
        client.ask(R"({"jsonrpc":"2.0","id":1,"method":"result.get","params":{"seq":)" + std::to_string(seq) + "}}");
    EXPECT_LE(line.size(), 440U) << line;
    const json result = json::parse(line)["result"];
    EXPECT_EQ(result["v"], verdict) << line;
    ASSERT_EQ(result["m"].size(), 3U) << line;
    EXPECT_EQ(result["m"][0][0], "step");
    EXPECT_EQ(result["more"], 0);
    if (verdict == "invalid") {
      EXPECT_TRUE(result["m"][0][1].is_null()) << line;
      EXPECT_EQ(result["c"], json::array({1122})) << line;
    } else {
      EXPECT_NEAR(result["m"][0][1].get<double>(), 50.0, 1.0) << line;
      EXPECT_GT(result["m"][0][2].get<double>(), 0.0) << line;
    }
    EXPECT_EQ(ask("system.state", json::object())["ready"], true) << "the machine's state does not follow the part's";
  }
}

TEST_F(AMeasuringMicroscope, GivesTheSameValuesFromTheFolderOfItsResult) {
  start_with_recipes();
  begin(1, "good");
  ASSERT_EQ(await_end(1)["state"], "completed");
  const std::filesystem::path folder = result_dir(1);

  ResultSurface read = read_result_surface(folder);
  note_window(read.result.focus, read.surface);
  const Recipe recipe = parse_recipe(test::read_text(recipes_.path() / "good.json"), "good");
  const Evaluation again =
      evaluate_surface(read.surface, recipe.evaluation, read_evaluation_context(folder, read.result), nullptr);

  ASSERT_TRUE(read.result.evaluation);
  EXPECT_EQ(values_of(again), values_of(*read.result.evaluation));
  EXPECT_EQ(again.order, (std::vector<std::string>{"step", "land", "line"}));
  const EvaluatedValue& height = again.measurements.at("step").values.at("height_um");
  ASSERT_EQ(height.budget.size(), 2U);
  EXPECT_EQ(height.budget[1].source, "slice_z");
  EXPECT_EQ(ask("result.get", {{"seq", 1}, {"format", "complete"}})["result"]["evaluation"]["verdict"], "pass");
}

}  // namespace
}  // namespace fvd
