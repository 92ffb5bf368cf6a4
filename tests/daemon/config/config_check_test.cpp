/// Which configurations can be used, and how one that stands in several files is read.

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/config/config_file.hpp"
#include "tests/daemon/config/problem_matcher.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::problem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A configuration to which check_config has nothing to say.
class AUsableConfig : public ::testing::Test {
 protected:
  AUsableConfig() {
    config_.camera.address = "192.168.1.5";
    config_.stage.profile = FVD_SOURCE_DIR "/config/drives/oriental-az.json";
    config_.paths.recipe_dir = folder_.path();
  }
  test::ScratchDir folder_;
  Config config_;
};

TEST_F(AUsableConfig, HasNoProblems) { EXPECT_THAT(check_config(config_), IsEmpty()); }

TEST_F(AUsableConfig, NeedsANumericAddressToListenOn) {
  config_.rpc.address = "localhost";
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/rpc/address", "'localhost'")));
  config_.rpc.address = "::1";
  EXPECT_THAT(check_config(config_), IsEmpty());
}

TEST_F(AUsableConfig, NeedsAddressesThatCanBe) {
  config_.rpc.address = "224.0.0.1";
  config_.camera.address = "192.168.1.300";
  config_.stage.address = "255.255.255.255";
  EXPECT_THAT(check_config(config_),
              ::testing::UnorderedElementsAre(problem("/rpc/address", "nobody can listen"),
                                              problem("/camera/address", "four numbers within 0..255"),
                                              problem("/stage/address", "stands for many machines")));
}

TEST_F(AUsableConfig, NeedsToKnowWhoMayWhatFromTheNetwork) {
  for (const char* address : {"0.0.0.0", "::", "192.168.1.5"}) {
    config_.rpc.address = address;
    config_.rpc.access = {};
    EXPECT_THAT(check_config(config_), ElementsAre(problem("/rpc/address", "nothing says who may move the stage")));
    config_.rpc.access.allow = {{"192.168.1.10", Role::kOperate}};
    EXPECT_THAT(check_config(config_), IsEmpty());
    config_.rpc.access.allow.clear();
    config_.rpc.access.token_file = folder_ / "tokens";
    EXPECT_THAT(check_config(config_), ElementsAre(problem("/rpc/token_file", "cannot read")));
    test::write_text(folder_ / "tokens", "");
    EXPECT_THAT(check_config(config_), IsEmpty());
    test::write_text(folder_ / "tokens", "anna\n");
    EXPECT_THAT(check_config(config_), ElementsAre(problem("/rpc/token_file", "line 1")));
    std::filesystem::remove(folder_ / "tokens");
  }
}

TEST_F(AUsableConfig, GivesNobodyRecipesOrConstantsByAnAddressThatIsEverybodys) {
  for (const char* address : {"0.0.0.0/0", "::/0", "::ffff:0:0/96"}) {
    for (const Role role : {Role::kSetUp, Role::kAdminister}) {
      config_.rpc.access.allow = {{address, role}};
      EXPECT_THAT(check_config(config_), ElementsAre(problem("/rpc/allow/0/address", "everybody"))) << address;
    }
    config_.rpc.access.allow = {{address, Role::kOperate}};
    EXPECT_THAT(check_config(config_), IsEmpty()) << address;
  }
  config_.rpc.access.allow = {{"10.0.0.0/8", Role::kAdminister}, {"::", Role::kAdminister}};
  EXPECT_THAT(check_config(config_), IsEmpty()) << "a network, and one address";
}

TEST_F(AUsableConfig, NeedsTokensForHttpFromTheNetwork) {
  for (const char* address : {"0.0.0.0", "::", "192.168.1.5"}) {
    config_.http.address = address;
    config_.http.port = 7413;
    config_.rpc.access = {};
    config_.rpc.access.allow = {{"192.168.1.0/24", Role::kOperate}};
    EXPECT_THAT(check_config(config_), ElementsAre(problem("/http/address", "a token alone")));
    test::write_text(folder_ / "tokens", "");
    config_.rpc.access.token_file = folder_ / "tokens";
    EXPECT_THAT(check_config(config_), IsEmpty());
    config_.http.port.reset();
    config_.rpc.access = {};
    EXPECT_THAT(check_config(config_), IsEmpty()) << "nobody listens";
  }
}

TEST_F(AUsableConfig, NeedsAPortAndNamesForHttp) {
  config_.http.port = config_.rpc.port;
  config_.http.hosts = {{"fvd.line3.example"}, {"http://fvd"}, {"fvd:7413"}, {""}};
  EXPECT_THAT(check_config(config_),
              ElementsAre(problem("/http/port", "speaks no HTTP"), problem("/http/hosts/1/name", "is no name"),
                          problem("/http/hosts/2/name"), problem("/http/hosts/3/name")));
  config_.http = {};
  config_.http.address = "localhost";
  config_.http.port = 0;
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/http/address", "'localhost'")));
}

TEST_F(AUsableConfig, NeedsAPortForEachListener) {
  config_.http.port = config_.rpc.port;
  config_.http.address = "0.0.0.0";
  config_.rpc.access.token_file = folder_ / "tokens";
  test::write_text(folder_ / "tokens", "");
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/http/port", "/rpc/port"))) << "it has 127.0.0.1 too";
  config_.http.address = "127.0.0.2";
  EXPECT_THAT(check_config(config_), IsEmpty()) << "another address";
  config_.http.address = "127.0.0.1";
  config_.http.port = 7413;
  config_.metrics.address = "::";
  config_.metrics.port = 7413;
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/metrics/port", "/http/port")));
  config_.metrics.port = config_.rpc.port;
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/metrics/port", "/rpc/port")));
  config_.http.port = config_.metrics.port = config_.rpc.port = 0;
  EXPECT_THAT(check_config(config_), IsEmpty()) << "any that is free";
}

TEST_F(AUsableConfig, MayHaveOnePortAtAddressesThatDoNotMeet) {
  config_.rpc.port = 0;
  config_.rpc.access.token_file = folder_ / "tokens";
  test::write_text(folder_ / "tokens", "");
  config_.http.port = config_.metrics.port = 7413;
  const auto meet = [this](const char* http, const char* metrics) {
    config_.http.address = http;
    config_.metrics.address = metrics;
    const Problems found = check_config(config_);
    return std::any_of(found.begin(), found.end(), [](const Problem& one) { return one.pointer == "/metrics/port"; });
  };
  EXPECT_FALSE(meet("0.0.0.0", "::1"));
  EXPECT_FALSE(meet("::1", "0.0.0.0"));
  EXPECT_FALSE(meet("fe80::1%eth0", "fe80::1%eth1"));
  EXPECT_TRUE(meet("fe80::1%eth0", "fe80::1%eth0"));
  EXPECT_TRUE(meet("0.0.0.0", "::"));
  EXPECT_TRUE(meet("127.0.0.1", "::"));
  EXPECT_TRUE(meet("::", "::1"));
  EXPECT_TRUE(meet("0.0.0.0", "127.0.0.1"));
}

TEST_F(AUsableConfig, NeedsRangesOfAddresses) {
  config_.rpc.access.allow = {
      {"192.168.1.10/24", Role::kView}, {"10.0.0.0/8", Role::kView}, {"10.0.0.0/8", Role::kOperate}};
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/rpc/allow/0/address", "no range"),
                                                 problem("/rpc/allow/2/address", "stands there already")));
}

TEST_F(AUsableConfig, NeedsAShortPathForTheSocket) {
  config_.paths.runtime_dir = "/" + std::string(120, 'r');
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/paths/runtime_dir", "too long for a socket")));
  config_.rpc.socket = "/run/fvd.sock";
  EXPECT_THAT(check_config(config_), IsEmpty());
}

TEST_F(AUsableConfig, NeedsACameraAddress) {
  config_.camera.address.clear();
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/camera/address", "is empty")));
}

TEST_F(AUsableConfig, NeedsAnAddressToSearchAt) {
  config_.camera.search_address = "left";
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/camera/search_address", "'left' is no IPv4 address")));
  config_.camera.search_address = "192.168.1.255";
  EXPECT_THAT(check_config(config_), IsEmpty());
}

TEST_F(AUsableConfig, NeedsLimitsInOrder) {
  config_.stage.max = config_.stage.min;
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/stage/min_um", "not below /stage/max_um")));
}

TEST_F(AUsableConfig, NeedsRoomForTheTakeUp) {
  config_.stage.min = Micrometers{0};
  config_.stage.max = Micrometers{10};
  config_.stage.take_up = Micrometers{10};
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/stage/take_up_um", "no room")));
}

TEST_F(AUsableConfig, NeedsAnotherNameForEachObjective) {
  const ObjectiveConfig twenty{"20x", 0.4, 20.0, 11.0};
  config_.objectives = {twenty, {"50x", 0.55, 50.0, 3.1}};
  EXPECT_THAT(check_config(config_), IsEmpty());
  config_.objectives.push_back(twenty);
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/objectives/2/name", "the name of /objectives/0 too")));
  config_.objectives = {{"", 0.4, 20.0, 11.0}, {"20\n", 0.4, 20.0, 11.0}};
  EXPECT_THAT(check_config(config_),
              ElementsAre(problem("/objectives/0/name", "no name"), problem("/objectives/1/name", "no name")));
}

TEST_F(AUsableConfig, NeedsSoftLimitsInsideTheStages) {
  config_.stage.min = Micrometers{-100};
  config_.stage.max = Micrometers{100};
  config_.stage.take_up = Micrometers{20};
  const auto with_limits = [this](std::optional<double> min_um, std::optional<double> max_um) {
    config_.objectives = {{"20x", 0.4, 20.0, 11.0, min_um, max_um}};
    return check_config(config_);
  };
  EXPECT_THAT(with_limits(-100, 100), IsEmpty());
  EXPECT_THAT(with_limits(79, {}), IsEmpty());
  EXPECT_THAT(with_limits(-100.5, {}), ElementsAre(problem("/objectives/0/min_um", "-100..100")));
  EXPECT_THAT(with_limits({}, 100.5), ElementsAre(problem("/objectives/0/max_um", "outside the stage's limits")));
  EXPECT_THAT(with_limits(200, -200),
              ElementsAre(problem("/objectives/0/min_um", "200"), problem("/objectives/0/max_um", "-200")));
  EXPECT_THAT(with_limits(10, -10), ElementsAre(problem("/objectives/0/min_um", "10..-10 um is no range")));
  EXPECT_THAT(with_limits(5, 5), ElementsAre(problem("/objectives/0/min_um", "no range")));
  EXPECT_THAT(with_limits({}, -100), ElementsAre(problem("/objectives/0/max_um", "no range")));
  EXPECT_THAT(with_limits(80, {}), ElementsAre(problem("/objectives/0/min_um", "take_up_um of 20 leaves no room")));
}

TEST_F(AUsableConfig, NeedsAScaleThatTellsTemperaturesApart) {
  config_.temperature.scale = 0.0;
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/temperature/scale", "0.001")));
}

TEST_F(AUsableConfig, NeedsItsFiles) {
  config_.stage.profile = folder_.path() / "absent.json";
  config_.paths.recipe_dir = folder_.path() / "absent";
  EXPECT_THAT(check_config(config_),
              ElementsAre(problem("/stage/profile", "absent.json"), problem("/paths/recipe_dir", "No such file")));
  config_.stage.profile = folder_.path();
  EXPECT_THAT(check_config(config_), Contains(problem("/stage/profile"))) << "a folder is no profile";
  config_.stage.profile = folder_.path() / "drive.json";
  std::ofstream(config_.stage.profile) << R"({"name": "half a drive"})";
  EXPECT_THAT(check_config(config_), Contains(problem("/stage/profile", "drive.json")));
}

TEST_F(AUsableConfig, ReplaysOnBothSidesOrNone) {
  config_.camera.driver = "replay";
  config_.camera.replay_dir = folder_.path();
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/stage/driver", "both")));
  config_.stage.driver = "replay";
  EXPECT_THAT(check_config(config_), IsEmpty());
  config_.stage.reversed = true;
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/stage/reversed", "tell their own z")));
  config_.stage.reversed = false;
  config_.camera.replay_dir = folder_.path() / "absent";
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/camera/replay_dir", "absent")));
}

TEST_F(AUsableConfig, IsNotJudgedByADefaultInPlaceOfARefusedValue) {
  config_.stage.min = Micrometers{2000};
  config_.stage.max = Micrometers{1000};
  config_.camera.driver = "replay";
  const Problems read{{"/stage/max_um", "\"x\" is not accepted"}, {"/camera", "5 is not an object { }"}};
  EXPECT_THAT(check_config(config_, read), IsEmpty());
  config_.rpc.address = "localhost";
  EXPECT_THAT(check_config(config_, read), ElementsAre(problem("/rpc/address", "'localhost'")));
}

class AConfigInParts : public ::testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    std::ofstream(folder_.path() / name) << text;
  }
  [[nodiscard]] LoadedConfig load(const Overrides& overrides = {}) const {
    return load_config(folder_.path() / "fvd.json", overrides);
  }
  test::ScratchDir folder_;
};

TEST_F(AConfigInParts, IsMergedInTheOrderOfTheNames) {
  put("fvd.json", R"({"rpc": {"port": 1, "max_connections": 3}, "log": {"level": "warn"},
                      "objectives": [{"name": "20x", "na": 0.4, "magnification": 20, "working_distance_mm": 11}]})");
  put("conf.d/20-line.json", R"({"rpc": {"port": 3}, "objectives": []})");
  put("conf.d/10-site.json", R"({"rpc": {"port": 2}, "log": {"level": null}, "compute": {"threads": 7}})");
  put("conf.d/30-old.json.dpkg-old", "{");
  put("conf.d/.hidden.json", "{");
  const LoadedConfig loaded = load();
  EXPECT_EQ(loaded.config.rpc.port, 3);
  EXPECT_EQ(loaded.config.rpc.max_connections, 3);
  EXPECT_EQ(loaded.config.log.level, LogConfig{}.level) << "null takes away";
  EXPECT_EQ(loaded.config.compute.threads, 7);
  EXPECT_TRUE(loaded.config.objectives.empty()) << "lists are replaced as a whole";
}

TEST_F(AConfigInParts, TellsTheOriginOfEveryValue) {
  put("fvd.json", R"({"rpc": {"port": 1}, "log": {"level": "warn"}, "compute": {"threads": 1}})");
  put("conf.d/10-site.json", R"({"rpc": {"port": 2}, "log": {"level": null}})");
  const LoadedConfig loaded = load({"compute.threads=2"});
  EXPECT_EQ(loaded.origins.of("/rpc/port"), "conf.d/10-site.json");
  EXPECT_EQ(loaded.origins.of("/log/level"), "default");
  EXPECT_EQ(loaded.origins.of("/compute/threads"), "--set");
  const std::string text = config_text_with_origins(loaded);
  EXPECT_THAT(text, HasSubstr("\"port\": 2,  // conf.d/10-site.json\n"));
  EXPECT_THAT(text, HasSubstr("\"threads\": 2,  // --set\n"));
  EXPECT_EQ(config_text(parse_config(text, "").config), config_text(loaded.config)) << "it is read back";
}

TEST_F(AConfigInParts, SaysWhichPartIsWrong) {
  put("fvd.json", R"({"rpc": {"port": -1}})");
  put("conf.d/10-site.json", R"({"log": {"level": "loud"}})");
  const Problems problems = load().problems;
  EXPECT_THAT(problems, Contains(problem("/rpc/port", "within 0..65535")));
  EXPECT_THAT(problems, Contains(problem("/log/level", "(in conf.d/10-site.json, beside fvd.json)")));
}

TEST_F(AConfigInParts, SaysWhereBothValuesStandThatDoNotFit) {
  put("fvd.json", R"({"stage": {"min_um": -500}})");
  put("conf.d/20-a.json", R"({"stage": {"max_um": -900}})");
  EXPECT_THAT(load().problems, Contains(problem("/stage/min_um",
                                                "-500 is not below /stage/max_um, -900 (/stage/max_um in "
                                                "conf.d/20-a.json, beside fvd.json)")));
  EXPECT_THAT(load({"stage.min_um=-400"}).problems,
              Contains(problem("/stage/min_um", "-900 (from --set) (/stage/max_um in conf.d/20-a.json")));
}

TEST_F(AConfigInParts, IsShownWithPathsThatHoldElsewhere) {
  put("fvd.json", R"({"paths": {"state_dir": "state", "recipe_dir": "../recipes"}, "rpc": {"token_file": "tokens"}})");
  const std::string folder = folder_.path().string();
  const std::string text = config_text_with_origins(load());
  EXPECT_THAT(text, HasSubstr("\"state_dir\": \"" + std::filesystem::absolute("state").string() + "\""));
  EXPECT_THAT(text, HasSubstr("\"token_file\": \"" + folder + "/tokens\""));
  EXPECT_THAT(text, HasSubstr("\"recipe_dir\": \"" + folder_.path().parent_path().string() + "/recipes\""));
  EXPECT_EQ(config_text_with_origins(parse_config(text, "/elsewhere")).find("/elsewhere"), std::string::npos);
}

TEST_F(AConfigInParts, SaysNothingMoreOfWhatCannotBeRead) {
  put("fvd.json", R"({"rpc": {"port": 1},})");
  EXPECT_THAT(load().problems, ElementsAre(problem("", "no valid JSON at line 1, column 21")));
  put("fvd.json", R"({"camera": {"address": "10.0.0.1"}})");
  put("conf.d/10-site.json", "{\n\"rpc\" 5}");
  EXPECT_THAT(load().problems, ElementsAre(problem("", "conf.d/10-site.json: no valid JSON at line 2")));
  put("conf.d/10-site.json", "[]");
  EXPECT_THAT(load().problems, ElementsAre(problem("", "conf.d/10-site.json: is no JSON object")));
  std::filesystem::remove_all(folder_.path() / "conf.d");
  put("conf.d", "a file");
  EXPECT_THAT(load().problems, ElementsAre(problem("", "cannot list folder")));
}

}  // namespace
}  // namespace fvd
