/// A record of another evaluation: the surface of its source, the recipe of its own.

#include "daemon/pipeline/evaluation_record.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "config/field_writer.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/pipeline/evaluation_input.hpp"
#include "daemon/pipeline/job_memory.hpp"
#include "daemon/pipeline/reconstruct.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

/// As result.json has it.
json json_of(Evaluation evaluation) {
  return json::parse(fields_to_json([&](Fields& fields) { describe(evaluation, fields); }).dump());
}

std::string recipe_text(const std::string& upper_um, const std::string& more = "") {
  return R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 3}},
    "reconstruct": {"lateral": {"pixel_pitch_x_um": 2, "pixel_pitch_y_um": 4}},
    "evaluation": {"measurements": {"texture": {"kind": "areal", "parameters": ["Sa", "Sz"],
      "limits": {"Sz_um": {"upper": )" +
         upper_um + "}}}}}" + more + "}";
}

/// 40 x 30 points whose heights differ by 349 um.
ResultData acquired() {
  ResultData data = test::sample_result();
  data.map = test::sample_map(40, 30);
  data.exports = std::vector<std::string>{"gsf", "tiff", "mask.png", "step_log.csv"};
  return data;
}

class ARecord : public testing::Test {
 protected:
  EvaluationRecord write(const std::string& name, const Recipe& recipe) {
    AtomicDirectory directory(folder_ / name);
    EvaluationRecord record =
        write_evaluation_record(directory, read_stored_surface(folder_ / "J7"), recipe, head(name), nullptr);
    directory.commit();
    return record;
  }
  static EvaluationRecordHead head(const std::string& id) {
    return {id, "9.9.9", std::chrono::system_clock::time_point(std::chrono::milliseconds(1'800'000'000'000))};
  }

  test::ScratchDir folder_;
};

TEST_F(ARecord, HasTheValuesThatTheJobWouldHaveHadWithThatRecipe) {
  const ResultData data = acquired();
  write_result(folder_ / "J7", data);
  const Recipe recipe = parse_recipe(recipe_text("400"), "texture");

  const EvaluationRecord record = write("J7-e1", recipe);

  const Evaluation same =
      evaluate_surface(evaluated_surface(data), recipe.evaluation, evaluation_context(data), nullptr);
  EXPECT_EQ(json::parse(record.json)["evaluation"], json_of(same));
  EXPECT_EQ(record.verdict, Verdict::kPass);
}

TEST_F(ARecord, TellsItsSourceItsRecipeAndItsFiles) {
  ResultData data = acquired();
  const Recipe first = parse_recipe(recipe_text("100"), "first");
  data.evaluation = evaluate_surface(evaluated_surface(data), first.evaluation, evaluation_context(data), nullptr);
  write_result(folder_ / "J7", data);
  const std::string before = test::read_text(folder_ / "J7/result.json");

  const EvaluationRecord record = write("J7-e1", parse_recipe(recipe_text("400"), "texture"));

  const json told = json::parse(record.json);
  EXPECT_EQ(told["source"]["job_id"], "J7");
  EXPECT_EQ(told["source"]["recipe"]["id"], "chapter");
  EXPECT_EQ(told["source"]["verdict"], "fail");
  EXPECT_EQ(told["source"]["software_version"], "1.2.3");
  EXPECT_EQ(told["source"]["surface_sha256"].get<std::string>().size(), 64U);
  EXPECT_EQ(told["verdict"], "pass");
  EXPECT_EQ(told["job"]["job_id"], "J7-e1");
  EXPECT_EQ(told["job"]["part_id"], "part-42");
  EXPECT_EQ(told["recipe"]["id"], "texture");
  EXPECT_EQ(told["recipe"]["sha256"], recipe_sha256(recipe_text("400")));
  EXPECT_EQ(told["provenance"]["software_version"], "9.9.9");
  EXPECT_EQ(told["evaluated"], "2027-01-15T08:00:00.000Z");
  EXPECT_EQ(told["values"], json::parse(before)["values"]);
  EXPECT_EQ(told["files"][0]["name"], "report.pdf");
  EXPECT_EQ(test::read_text(folder_ / "J7-e1/result.json"), record.json);
  EXPECT_EQ(test::read_text(folder_ / "J7-e1/report.pdf").substr(0, 5), "%PDF-");
  EXPECT_EQ(test::read_text(folder_ / "J7/result.json"), before);
}

TEST_F(ARecord, TakesNoRepeatabilityOfAnotherRecipe) {
  ResultData data = acquired();
  data.recipe_id = "texture";
  data.repeatability["texture.Sz_um"] = {5.0, 24.0, "study-0009"};
  write_result(folder_ / "J7", data);

  const json own = json::parse(write("J7-e1", parse_recipe(recipe_text("400"), "texture")).json);
  const json other = json::parse(write("J7-e2", parse_recipe(recipe_text("400"), "another")).json);

  const auto sources = [](const json& record) { return record["evaluation"]["measurements"]["texture"].dump(); };
  EXPECT_THAT(sources(own), ::testing::HasSubstr("\"source\":\"repeatability\""));
  EXPECT_THAT(sources(other), ::testing::Not(::testing::HasSubstr("\"source\":\"repeatability\"")));
}

TEST_F(ARecord, HasNoReportWhereTheRecipeDoesWithout) {
  write_result(folder_ / "J7", acquired());

  const EvaluationRecord record =
      write("J7-e1", parse_recipe(recipe_text("400", R"(, "report": {"pdf": false})"), "texture"));

  EXPECT_TRUE(json::parse(record.json)["files"].empty());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "J7-e1/report.pdf"));
}

TEST(AReevaluation, IsRefusedBeyondTheMemoryBudget) {
  const Recipe recipe = parse_recipe(recipe_text("400"), "texture");

  EXPECT_NO_THROW(require_evaluation_memory(recipe, 100, 100, 2'000'000));
  FVD_EXPECT_ERROR(kMemoryBudget, require_evaluation_memory(recipe, 2448, 2048, std::size_t{64} << 20U));
}

TEST(ARecipesReport, ComesAndGoesWithoutChangingTheOtherFiles) {
  const auto files = [](const std::string& more) {
    ResultData data;
    note_recipe(parse_recipe(recipe_text("400", more), "texture"), data);
    return data.exports;
  };

  EXPECT_EQ(files(""), std::nullopt);
  EXPECT_EQ(files(R"(, "report": {"language": "en"})"), std::nullopt);
  EXPECT_THAT(files(R"(, "report": {"pdf": true}, "export": ["x3p"])").value(), ElementsAre("x3p", "report.pdf"));
  EXPECT_THAT(files(R"(, "report": {"pdf": true}, "export": ["report.pdf"])").value(), ElementsAre("report.pdf"));
  EXPECT_THAT(files(R"(, "report": {"pdf": false}, "export": ["x3p", "report.pdf"])").value(), ElementsAre("x3p"));
  const auto with = chosen_exporters(files(R"(, "report": {"pdf": true})"));
  const auto without = chosen_exporters(files(R"(, "report": {"pdf": false})"));
  EXPECT_EQ(with.size(), chosen_exporters(std::nullopt).size() + 1);
  EXPECT_EQ(with.back().name, "report.pdf");
  EXPECT_EQ(without.size(), chosen_exporters(std::nullopt).size());
}

TEST(ARecipesReport, IsWrittenInNoOtherLanguageYet) {
  FVD_EXPECT_ERROR(kBadRecipe,
                   static_cast<void>(parse_recipe(recipe_text("400", R"(, "report": {"language": "de"})"), "texture")));
}

}  // namespace
}  // namespace fvd
