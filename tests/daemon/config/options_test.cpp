#include "daemon/options.hpp"

#include <fstream>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/base/exit_code.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Fvd : public ::testing::Test {
 protected:
  ParsedOptions parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "fvd");
    return parse_options(static_cast<int>(arguments.size()), arguments.data(), out_, err_);
  }
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(Fvd, ReadsItsStandardFileUnlessTold) {
  EXPECT_EQ(parse({}).options.config_file, "/etc/fvd/fvd.json");
  EXPECT_EQ(parse({"--config", "x.json"}).options.config_file, "x.json");
  EXPECT_FALSE(parse({"--check-recipe", "x.json"}).options.config_is_told);
  EXPECT_TRUE(parse({"--config", "x.json"}).options.config_is_told);
  EXPECT_TRUE(parse({"--set", "rpc.port=0"}).options.config_is_told);
  EXPECT_FALSE(parse({}).exit);
}

TEST_F(Fvd, CollectsOverrides) {
  EXPECT_THAT(parse({"--set", "rpc.port=0", "--set=log.level=debug"}).options.overrides,
              ElementsAre("rpc.port=0", "log.level=debug"));
}

TEST_F(Fvd, TellsItsVersion) {
  EXPECT_EQ(parse({"--version"}).exit, exit_code::kOk);
  EXPECT_THAT(out_.str(), ::testing::MatchesRegex("fvd [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(Fvd, HelpNamesEveryOption) {
  EXPECT_EQ(parse({"--help"}).exit, exit_code::kOk);
  for (const char* option : {"--config", "--set", "--check-config", "--check-recipe", "--dump-config", "--version"}) {
    EXPECT_THAT(out_.str(), HasSubstr(option));
  }
}

TEST_F(Fvd, RefusesWrongArguments) {
  for (const auto& arguments :
       std::vector<std::vector<const char*>>{{"--confg", "x"}, {"--config"}, {"x"}, {"--set"}}) {
    EXPECT_EQ(parse(arguments).exit, exit_code::kUsage) << arguments[0];
  }
  EXPECT_THAT(err_.str(), HasSubstr("--confg"));
}

Options with_overrides(const Overrides& overrides) {
  Options options;
  options.overrides = overrides;
  return options;
}

Options asking_for(bool Options::*flag, const Overrides& overrides = {}) {
  Options options = with_overrides(overrides);
  options.*flag = true;
  return options;
}

class FvdWithAFile : public Fvd {
 protected:
  StartUp start(const std::string& text, Options options) {
    options.config_file = folder_.path() / "fvd.json";
    std::ofstream(options.config_file) << text;
    std::filesystem::create_directories(folder_.path() / "recipes");
    std::filesystem::copy_file(FVD_SOURCE_DIR "/config/drives/oriental-az.json", folder_.path() / "drive.json",
                               std::filesystem::copy_options::overwrite_existing);
    return start_up(options, out_, err_);
  }
  static constexpr const char* kGood =
      R"({"camera": {"address": "10.0.0.1"}, "stage": {"profile": "drive.json"}, "paths": {"recipe_dir": "recipes"}})";
  test::ScratchDir folder_;
};

TEST_F(FvdWithAFile, RunsWithAGoodConfiguration) {
  const StartUp result = start(kGood, with_overrides({"rpc.port=0"}));
  EXPECT_FALSE(result.exit);
  EXPECT_EQ(result.config.rpc.port, 0);
  EXPECT_THAT(err_.str(), IsEmpty());
}

TEST_F(FvdWithAFile, ChecksAGoodConfigurationSilently) {
  EXPECT_EQ(start(kGood, asking_for(&Options::check_config)).exit, exit_code::kOk);
  EXPECT_THAT(out_.str() + err_.str(), IsEmpty());
}

TEST_F(FvdWithAFile, SaysEveryProblemAndExitsWith78) {
  const std::string bad = R"({"rpc": {"port": -1}, "camera": {"adress": "x"}})";
  EXPECT_EQ(start(bad, asking_for(&Options::check_config)).exit, 78);
  EXPECT_THAT(
      err_.str(),
      AllOf(HasSubstr("fvd.json: /rpc/port: -1 is not accepted; expected an integer within 0..65535"),
            HasSubstr("fvd.json: /camera/adress: unknown key; did you mean 'address'?"), HasSubstr("/stage/profile")));
  EXPECT_EQ(start(bad, {}).exit, 78) << "it does not run either";
}

TEST_F(FvdWithAFile, ChecksARecipeWithoutAConfiguration) {
  const auto check = [this](const std::string& text) {
    Options options;
    options.config_file = folder_.path() / "absent.json";
    options.check_recipe = folder_.path() / "part.json";
    std::ofstream(options.check_recipe) << text;
    return start_up(options, out_, err_).exit;
  };
  const std::string scan = R"("scan": {"start_um": 0, "step_um": 1, "slices": 3})";
  EXPECT_EQ(check(R"({"format": 2, "acquire": {)" + scan + "}}"), exit_code::kOk);
  EXPECT_EQ(err_.str(), "");
  EXPECT_EQ(check("{" + scan + "}"), exit_code::kOk);
  EXPECT_THAT(err_.str(), HasSubstr("part.json: note: has format 1"));
  EXPECT_EQ(check(R"({"format": 2, "aquire": {}})"), 78);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("recipe part: /acquire: is missing"),
                                HasSubstr("recipe part: /aquire: unknown key; did you mean 'acquire'?")));
  Options absent;
  absent.check_recipe = folder_.path() / "no-such.json";
  EXPECT_EQ(start_up(absent, out_, err_).exit, 78);
  EXPECT_THAT(err_.str(), HasSubstr("no-such.json"));
}

TEST_F(FvdWithAFile, ChecksARecipeAgainstTheStageOfAConfigurationThatIsTold) {
  const auto check =
      [this](bool told, const Overrides& overrides) {
        Options options = with_overrides(overrides);
        options.config_is_told = told;
        options.check_recipe = folder_.path() / "part.json";
        std::ofstream(options.check_recipe)
            << R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 1, "slices": 3}}, "x": 1})";
        err_.str("");
        return start(kGood, options).exit;
      };
  const Overrides near{"stage.min_um=-5", "stage.max_um=1.5", "stage.take_up_um=2"};
  EXPECT_EQ(check(true, near), 78);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("recipe part: /x: unknown key"),
                                HasSubstr("recipe part: /acquire/scan/slices: 3 slices reach 2 um")));
  EXPECT_EQ(check(true, {"stage.min_um=-5", "stage.max_um=2", "stage.take_up_um=2"}), 78);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("/x: unknown key"), ::testing::Not(HasSubstr("/acquire"))));
  EXPECT_EQ(check(false, near), 78);
  EXPECT_THAT(err_.str(), ::testing::Not(HasSubstr("/acquire")));
  EXPECT_EQ(check(true, {"stage.min_um=7", "stage.max_um=1.5"}), 78);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("fvd.json: /stage/"), ::testing::Not(HasSubstr("recipe part"))))
      << "a configuration that is refused tells nothing of a recipe";
}

TEST_F(FvdWithAFile, ChecksRecipesAndFoldersToo) {
  std::filesystem::create_directories(folder_.path() / "recipes");
  std::ofstream(folder_.path() / "recipes/part.json") << R"({"format": 2, "aquire": {}})";
  std::ofstream(folder_.path() / "file") << "x";
  const std::string folder = folder_.path().string();
  const Options check =
      asking_for(&Options::check_config, {"paths.recipe_dir=recipes", "paths.state_dir=" + folder + "/file/state",
                                          "paths.runtime_dir=" + folder + "/not/yet"});
  EXPECT_EQ(start(kGood, check).exit, 78);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("/paths/recipe_dir: recipe part: "), HasSubstr("/aquire: unknown key"),
                                HasSubstr("/paths/state_dir: '" + folder + "/file' is no folder"),
                                ::testing::Not(HasSubstr("/paths/runtime_dir"))));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "not")) << "nothing is made";
}

TEST_F(FvdWithAFile, ChecksThatFoldersAreNoneOfTheKernel) {
  for (const char* folder : {"/proc/fvd", "/sys/fvd"}) {
    err_.str("");
    const std::string state = std::string("paths.state_dir=") + folder;
    EXPECT_EQ(start(kGood, asking_for(&Options::check_config, {state})).exit, 78);
    EXPECT_THAT(err_.str(), AllOf(HasSubstr("/paths/state_dir: '"), HasSubstr("is of the kernel")));
  }
}

TEST_F(FvdWithAFile, WarnsOfWhatIsNotThereYetOrIsEverybodysAndTakesIt) {
  const Overrides missing{
      R"(rpc.groups=[{"group": "fvd", "role": "view"}, {"group": "no-such-group", "role": "view"}])",
      R"(rpc.allow=[{"address": "0.0.0.0/0", "role": "operate"}])",
      "temperature.file=/nowhere/temp",
      "stage.transport=rtu",
      "stage.serial_device=/dev/no-such",
      "stage.serial_baud=115200"};

  EXPECT_EQ(start(kGood, asking_for(&Options::check_config, missing)).exit, exit_code::kOk);

  EXPECT_THAT(err_.str(),
              AllOf(HasSubstr("fvd.json: warning: /rpc/groups/1/group: there is no group 'no-such-group'"),
                    ::testing::Not(HasSubstr("/rpc/groups/0")),
                    HasSubstr("fvd.json: warning: /rpc/allow/0/address: '0.0.0.0/0' gives the role operate"),
                    HasSubstr("fvd.json: warning: /temperature/file: there is no '/nowhere/temp'"),
                    HasSubstr("fvd.json: warning: /stage/serial_device: there is no '/dev/no-such'")));
}

TEST_F(FvdWithAFile, DumpsTheConfigurationInForce) {
  EXPECT_EQ(start(kGood, asking_for(&Options::dump_config, {"rpc.port=77"})).exit, exit_code::kOk);
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("\"port\": 77,  // --set"), HasSubstr("drive.json"), HasSubstr("queue_slices")));
}

TEST_F(FvdWithAFile, PrintsItsSchemas) {
  EXPECT_EQ(start("{", asking_for(&Options::print_config_schema)).exit, exit_code::kOk);
  EXPECT_EQ(out_.str(), config_schema_text());
}

TEST(ExitCode, TellsWhatStoppedTheDaemon) {
  EXPECT_EQ(exit_code_of(ErrorCode::kBadConfig), 78);
  EXPECT_EQ(exit_code_of(ErrorCode::kStageDisconnected), 69);
  EXPECT_EQ(exit_code_of(ErrorCode::kDatabase), 74);
  EXPECT_EQ(exit_code_of(ErrorCode::kInternal), 70);
}

}  // namespace
}  // namespace fvd
