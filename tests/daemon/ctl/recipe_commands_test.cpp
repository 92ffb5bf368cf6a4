#include "daemon/ctl/recipe_commands.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "tests/daemon/ctl/fake_rpc_server.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using fvd::test::Outcome;
using fvd::test::ScratchDir;
using nlohmann::json;
using test::FakeRpcServer;
using testing::HasSubstr;

constexpr const char* kOld = R"({"scan": {"start_um": -7, "step_um": 10, "slices": 21}})";

class FvdctlRecipe : public ::testing::Test {
 protected:
  Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "recipe");
    if (server) arguments.insert(arguments.begin(), {"--address", server->endpoint().text()});
    return fvd::test::run_command(arguments);
  }
  void answer(const char* method, const json& result) {
    server = std::make_unique<FakeRpcServer>(std::vector<FakeRpcServer::Step>{{method, FakeRpcServer::result(result)}});
  }
  std::string file(const std::string& text) {
    const auto path = folder_ / "part.json";
    std::ofstream(path) << text;
    return path.string();
  }
  std::unique_ptr<FakeRpcServer> server;
  ScratchDir folder_;
};

TEST_F(FvdctlRecipe, ListsWhatIsInForce) {
  answer("recipe.list", {{"entries", {{{"id", "a"}, {"version", 0}}, {{"id", "b"}, {"version", 3}}}}});
  EXPECT_EQ(run({"list"}).out, "a  shipped\nb  version 3\n");
}

TEST_F(FvdctlRecipe, ListsARecipeThatCannotBeUsedWithItsError) {
  answer("recipe.list",
         {{"entries", {{{"id", "a"}, {"edited", false}, {"version", 0}, {"error_message", "recipe a: /format: no"}}}}});
  EXPECT_EQ(run({"list"}).out, "a  shipped  recipe a: /format: no\n");
}

TEST_F(FvdctlRecipe, PrintsARecipeAsItStands) {
  answer("recipe.get", {{"text", "// why\n{}"}, {"version", 3}});
  const Outcome outcome = run({"get", "a"});
  EXPECT_EQ(outcome.out, "// why\n{}");
  EXPECT_THAT(outcome.err, HasSubstr("version 3"));
  EXPECT_EQ(server->requests().at(0)["params"], json({{"id", "a"}}));
}

TEST_F(FvdctlRecipe, SaysWhyADocumentIsRefused) {
  answer("recipe.check", {{"accepted", false}, {"refusal", "recipe part: /x: bad"}, {"notes", json::array()}});
  const Outcome outcome = run({"check", file("{}")});
  EXPECT_EQ(outcome.code, kExitBadData);
  EXPECT_THAT(outcome.err, HasSubstr("recipe part: /x: bad"));
  EXPECT_EQ(server->requests().at(0)["params"], json({{"id", "part"}, {"text", "{}"}}));
}

TEST_F(FvdctlRecipe, ShowsTheNotesOfAnAcceptedOne) {
  answer("recipe.check", {{"accepted", true}, {"notes", {"has format 1"}}, {"sha256", "abc"}});
  const Outcome outcome = run({"check", file(kOld)});
  EXPECT_EQ(outcome.code, kExitOk);
  EXPECT_THAT(outcome.out, HasSubstr("sha256 abc"));
  EXPECT_THAT(outcome.err, HasSubstr("note: has format 1"));
}

TEST_F(FvdctlRecipe, SavesAgainstTheBaseThatIsNamed) {
  answer("recipe.save", {{"id", "part"}, {"version", 4}});
  const Outcome outcome = run({"save", file("{}"), "--base", "3", "--author", "anna", "--comment", "c"});
  EXPECT_EQ(outcome.code, kExitOk);
  EXPECT_EQ(outcome.err, "fvdctl: recipe part: version 4 is in force now\n");
  EXPECT_EQ(server->requests().at(0)["params"],
            json({{"id", "part"}, {"text", "{}"}, {"base_version", 3}, {"author", "anna"}, {"comment", "c"}}));
}

TEST_F(FvdctlRecipe, SaysThatAnUnchangedRecipeWasNotSaved) {
  answer("recipe.save", {{"id", "part"}, {"version", 3}});
  const Outcome outcome = run({"save", file("{}"), "--base", "3", "--author", "anna"});
  EXPECT_EQ(outcome.code, kExitOk);
  EXPECT_EQ(json::parse(outcome.out)["version"], 3);
  EXPECT_EQ(outcome.err, "fvdctl: recipe part: nothing changed, version 3 with this text is in force already\n");
}

TEST_F(FvdctlRecipe, SavesANewRecipeUnderItsFilesName) {
  answer("recipe.save", {{"id", "part"}, {"version", 1}});
  EXPECT_EQ(run({"save", file("{}"), "--author", "anna"}).code, kExitOk);
  EXPECT_EQ(server->requests().at(0)["params"]["base_version"], 0);
}

TEST_F(FvdctlRecipe, TellsVersions) {
  answer(
      "recipe.versions",
      {{"versions", {{{"version", 2}, {"saved", "2026-11-28T10:00:00.000Z"}, {"author", "anna"}, {"comment", "c"}}}}});
  EXPECT_EQ(run({"versions", "a"}).out, "2  2026-11-28T10:00:00.000Z  anna  c\n");
}

TEST_F(FvdctlRecipe, RestoresAVersion) {
  answer("recipe.restore", {{"id", "a"}, {"version", 4}});
  EXPECT_EQ(run({"restore", "a", "1", "--base", "3", "--author", "anna"}).code, kExitOk);
  EXPECT_EQ(server->requests().at(0)["params"],
            json({{"id", "a"}, {"version", 1}, {"base_version", 3}, {"author", "anna"}}));
}

TEST_F(FvdctlRecipe, ConvertsWithoutADaemon) {
  const Outcome outcome = run({"convert", file(kOld)});
  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(outcome.out, convert_recipe(kOld, "part"));
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(run({"convert", file(std::string("// why\n") + kOld)}).err, HasSubstr("comments are not carried over"));
  EXPECT_EQ(run({"convert", file(outcome.out)}).code, kExitBadData) << "it is converted already";
}

TEST_F(FvdctlRecipe, NamesACommandThatItDoesNotHave) {
  const Outcome outcome = run({"delete", "a"});
  EXPECT_EQ(outcome.code, kExitUsage);
  EXPECT_THAT(outcome.err, HasSubstr("'delete' is not a command of recipe; expected one of list, get"));
}

TEST_F(FvdctlRecipe, RefusesWrongArguments) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{{},
                                                                                         {"get"},
                                                                                         {"save"},
                                                                                         {"save", "/no/such/file"},
                                                                                         {"restore", "a"},
                                                                                         {"restore", "a", "-1"},
                                                                                         {"delete", "a"}}) {
    EXPECT_EQ(run(arguments).code, kExitUsage);
  }
}

}  // namespace
}  // namespace fvd::ctl
