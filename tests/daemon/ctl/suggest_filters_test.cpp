/// fvdctl recipe suggest-filters, fvdctl evaluate, and refusals of numbers that people can read.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "tests/daemon/ctl/fake_rpc_server.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using nlohmann::json;
using test::FakeRpcServer;
using test::Outcome;
using test::run_command;
using testing::HasSubstr;

constexpr const char* kPlainRecipe = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 1, "slices": 11}, "camera": {"width_px": 480, "height_px": 360}},
  "reconstruct": {"focus": {"window_px": 9, "window": "box"},
                  "lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}}})";

TEST(SuggestFilters, PrintsChoiceTableAndFragment) {
  const Outcome outcome =
      run_command({"recipe", "suggest-filters", "--pitch-um", "1", "--window-px", "9", "--field-um", "480,360"});

  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("S filter    20 um\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\"nesting_um\": 50.0"));
}

TEST(SuggestFilters, TakesFromTheRecipeWhatIsNotGiven) {
  const test::ScratchDir folder;
  test::write_text(folder / "part.json", kPlainRecipe);
  const std::string recipe = (folder / "part.json").string();

  const Outcome told = run_command({"recipe", "suggest-filters", "--recipe", recipe, "--json"});
  ASSERT_EQ(told.code, kExitOk) << told.err;
  const json steps = json::parse(told.out)["evaluation"]["surfaces"]["texture"]["steps"];
  EXPECT_EQ(steps[1]["nesting_um"], 20.0);
  EXPECT_EQ(steps[2]["nesting_um"], 50.0);
  const Outcome given = run_command({"recipe", "suggest-filters", "--recipe", recipe, "--pitch-um", "0.5", "--json"});
  EXPECT_EQ(json::parse(given.out)["evaluation"]["surfaces"]["texture"]["steps"][1]["nesting_um"], 10.0);
}

TEST(SuggestFilters, NamesTheOptionThatIsMissing) {
  const auto refusal = [](std::vector<std::string> options) {
    options.insert(options.begin(), {"recipe", "suggest-filters"});
    const Outcome outcome = run_command(options);
    EXPECT_EQ(outcome.code, kExitUsage);
    return outcome.err;
  };

  EXPECT_THAT(refusal({}), HasSubstr("--pitch-um is missing"));
  EXPECT_THAT(refusal({"--pitch-um", "1"}), HasSubstr("--window-px is missing"));
  EXPECT_THAT(refusal({"--pitch-um", "1", "--window-px", "9"}), HasSubstr("--field-um is missing"));
  EXPECT_THAT(refusal({"--pitch-um", "1", "--window-px", "9", "--field-um", "480"}), HasSubstr("width and height"));
}

TEST(AnOptionThatTakesALength, IsRefusedInWordsThatFitOnALine) {
  for (const char* value : {"-1", "0", "nan", "inf", "1e999", "x"}) {
    const Outcome outcome =
        run_command({"recipe", "suggest-filters", "--window-px", value, "--pitch-um", "1", "--field-um", "480,360"});
    EXPECT_EQ(outcome.code, kExitUsage) << value;
    EXPECT_THAT(outcome.err, HasSubstr("is no number above 0")) << value;
    EXPECT_LT(outcome.err.size(), 200U) << value;
  }
  const Outcome range = run_command({"process", "/nowhere", "--out", "/nowhere/out", "--min-prominence", "2"});
  EXPECT_THAT(range.err, HasSubstr("'2' is no number from 0 to 1"));
}

TEST(Evaluate, AsksTheDaemonAndEndsWithTheVerdict) {
  for (const auto& [verdict, code] : std::vector<std::pair<json, int>>{{"pass", kExitOk},
                                                                       {nullptr, kExitOk},
                                                                       {"fail", kExitVerdictFail},
                                                                       {"uncertain", kExitVerdictUncertain},
                                                                       {"invalid", kExitVerdictInvalid}}) {
    FakeRpcServer server(
        {{"result.evaluate", FakeRpcServer::result({{"id", "J7-e1"}, {"job_id", "J7"}, {"verdict", verdict}})}});
    const Outcome outcome =
        run_command({"--address", server.endpoint().text(), "evaluate", "J7", "--recipe", "texture"});
    EXPECT_EQ(outcome.code, code) << verdict;
    EXPECT_EQ(json::parse(outcome.out)["id"], "J7-e1");
    EXPECT_EQ(server.requests().at(0)["params"], json({{"job_id", "J7"}, {"recipe", "texture"}}));
  }
}

TEST(Evaluate, NeedsARecipe) { EXPECT_EQ(run_command({"evaluate", "J7"}).code, kExitUsage); }

}  // namespace
}  // namespace fvd::ctl
