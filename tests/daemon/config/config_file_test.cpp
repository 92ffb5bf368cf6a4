#include "daemon/config/config_file.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/readable_name.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

auto problem(const std::string& pointer, const std::string& says = "") {
  return AllOf(Field("pointer", &Problem::pointer, pointer), Field("message", &Problem::message, HasSubstr(says)));
}

Problems problems_of(const std::string& text, const Overrides& overrides = {}) {
  return parse_config(text, "/etc/fvd", overrides).problems;
}

TEST(ConfigFile, TakesDefaultsForWhatIsAbsent) {
  const LoadedConfig loaded = parse_config("{}", "/etc/fvd");

  EXPECT_THAT(loaded.problems, IsEmpty());
  EXPECT_EQ(loaded.config.rpc.port, RpcConfig{}.port);
  EXPECT_EQ(loaded.config.paths.state_dir, PathsConfig{}.state_dir);
}

TEST(ConfigFile, ReadsEveryGroup) {
  const Config config = parse_config(R"({
    "rpc": {"address": "::1", "port": 0, "max_connections": 3, "idle_timeout_s": 5, "first_request_s": 7,
            "socket": "s.sock", "allow": [{"address": "10.0.0.0/8", "role": "operate"}], "loopback_role": "view",
            "groups": [{"group": "line", "role": "set_up"}], "token_file": "tokens"},
    "camera": {"driver": "replay", "address": "10.0.0.1", "packet_size_bytes": 9000, "packet_socket": false,
               "frame_margin_ms": 50, "simulated": true, "replay_dir": "slices"},
    "stage": {"driver": "replay", "profile": "p.json", "address": "drive", "port": 1502, "unit": 7,
              "response_timeout_ms": 100, "min_um": -5.5, "max_um": 6.5, "take_up_um": 2, "speed_um_per_s": 3,
              "acceleration_um_per_s2": 4, "simulated": true, "replay_start_um": 1, "replay_step_um": 0.5},
    "paths": {"state_dir": "s", "runtime_dir": "r", "recipe_dir": "recipes"},
    "compute": {"threads": 2, "memory_budget_mib": 100, "queue_slices": 8},
    "log": {"level": "debug"},
    "objectives": [{"name": "20x", "na": 0.4, "magnification": 20, "working_distance_mm": 11},
                   {"name": "50x", "na": 0.55, "magnification": 50, "working_distance_mm": 3.1, "min_um": -5, "max_um": 6}],
    "temperature": {"file": "t", "scale": 0.001, "offset_c": -0.5, "max_age_s": 60}})",
                                     "/etc/fvd")
                            .config;

  EXPECT_EQ(config.rpc.address, "::1");
  EXPECT_EQ(config.rpc.port, 0);
  EXPECT_EQ(config.rpc.max_connections, 3);
  EXPECT_EQ(config.rpc.idle_timeout_s, 5);
  EXPECT_EQ(config.rpc.first_request_s, 7);
  EXPECT_EQ(config.rpc.socket, "s.sock") << "relative to the current directory";
  ASSERT_EQ(config.rpc.access.allow.size(), 1U);
  EXPECT_EQ(config.rpc.access.allow[0].address, "10.0.0.0/8");
  EXPECT_EQ(config.rpc.access.allow[0].role, Role::kOperate);
  EXPECT_EQ(config.rpc.access.loopback_role, Role::kView);
  ASSERT_EQ(config.rpc.access.groups.size(), 1U);
  EXPECT_EQ(config.rpc.access.groups[0].group, "line");
  EXPECT_EQ(config.rpc.access.groups[0].role, Role::kSetUp);
  EXPECT_EQ(config.rpc.access.token_file, "/etc/fvd/tokens");
  EXPECT_EQ(config.camera.driver, "replay");
  EXPECT_EQ(config.camera.address, "10.0.0.1");
  EXPECT_EQ(config.camera.packet_size_bytes, 9000);
  EXPECT_FALSE(config.camera.packet_socket);
  EXPECT_EQ(config.camera.frame_margin_ms, 50);
  EXPECT_TRUE(config.camera.simulated);
  EXPECT_EQ(config.camera.replay_dir, "/etc/fvd/slices");
  EXPECT_EQ(config.stage.driver, "replay");
  EXPECT_EQ(config.stage.profile, "/etc/fvd/p.json");
  EXPECT_EQ(config.stage.address, "drive");
  EXPECT_EQ(config.stage.port, 1502);
  EXPECT_EQ(config.stage.unit, 7);
  EXPECT_EQ(config.stage.response_timeout.count(), 100);
  EXPECT_EQ(config.stage.min, Micrometers{-5.5});
  EXPECT_EQ(config.stage.max, Micrometers{6.5});
  EXPECT_EQ(config.stage.take_up, Micrometers{2});
  EXPECT_EQ(config.stage.speed_um_per_s, 3);
  EXPECT_EQ(config.stage.acceleration_um_per_s2, 4);
  EXPECT_TRUE(config.stage.simulated);
  EXPECT_EQ(config.stage.replay_start_um, 1);
  EXPECT_EQ(config.stage.replay_step_um, 0.5);
  EXPECT_EQ(config.paths.state_dir, "s") << "relative to the current directory";
  EXPECT_EQ(config.paths.runtime_dir, "r");
  EXPECT_EQ(config.paths.recipe_dir, "/etc/fvd/recipes");
  EXPECT_EQ(config.compute.threads, 2);
  EXPECT_EQ(config.compute.memory_budget_mib, 100);
  EXPECT_EQ(config.compute.queue_slices, 8);
  EXPECT_EQ(config.log.level, "debug");
  ASSERT_EQ(config.objectives.size(), 2U);
  EXPECT_EQ(config.objectives[0].name, "20x");
  EXPECT_EQ(config.objectives[0].na, 0.4);
  EXPECT_EQ(config.objectives[0].magnification, 20);
  EXPECT_EQ(config.objectives[0].working_distance_mm, 11);
  EXPECT_FALSE(config.objectives[0].min_um || config.objectives[0].max_um);
  EXPECT_EQ(config.objectives[1].min_um, -5);
  EXPECT_EQ(config.objectives[1].max_um, 6);
  EXPECT_EQ(config.temperature.file, "t") << "relative to the current directory";
  EXPECT_EQ(config.temperature.scale, 0.001);
  EXPECT_EQ(config.temperature.offset_c, -0.5);
  EXPECT_EQ(config.temperature.max_age_s, 60);
}

TEST(ConfigFile, AllowsComments) { EXPECT_THAT(problems_of("{ // why\n\"rpc\": {\"port\": 1} }"), IsEmpty()); }

TEST(ConfigFile, DumpsWhatItReadsBack) {
  Config config;
  config.rpc.port = 1;
  config.stage.min = Micrometers{-12.25};
  config.objectives = {{"20x", 0.4, 20.0, 11.0}, {"50x", 0.55, 50.0, 3.1, -10.0, 12.5}};
  config.temperature.file = "/sys/class/hwmon/hwmon0/temp1_input";
  const std::string text = config_text(config);

  const LoadedConfig again = parse_config(text, "");

  EXPECT_THAT(again.problems, IsEmpty());
  EXPECT_EQ(config_text(again.config), text);
}

TEST(ConfigFile, ReportsAllProblemsAtOnce) {
  EXPECT_THAT(problems_of(R"({"rpc": {"port": 70000, "prot": 1, "address": 5}, "stge": {}, "log": {"level": "loud"}})"),
              ::testing::UnorderedElementsAre(
                  problem("/rpc/port", "70000 is not accepted; expected an integer within 0..65535"),
                  problem("/rpc/prot", "did you mean 'port'?"), problem("/rpc/address", "expected a text"),
                  problem("/stge", "did you mean 'stage'?"), problem("/log/level", "\"debug\"")));
}

struct BadConfig {
  std::string text;
  std::string pointer;
  std::string says;
};

/// For the names of the tests.
void PrintTo(const BadConfig& of, std::ostream* out) { *out << of.pointer << ": " << of.says; }

class ABadConfig : public ::testing::TestWithParam<BadConfig> {};

TEST_P(ABadConfig, IsRefusedWithPointerAndReason) {
  EXPECT_THAT(problems_of(GetParam().text), ElementsAre(problem(GetParam().pointer, GetParam().says)));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ABadConfig,
    ::testing::Values(BadConfig{"", "", "line 1, column 1"}, BadConfig{"{\n\n  \"rpc\" 1}", "", "line 3, column 9"},
                      BadConfig{"{\"rpc\": {}}}", "", "line 1"}, BadConfig{"[]", "", "not an object"},
                      BadConfig{"5", "", "not an object"}, BadConfig{R"({"rpc": []})", "/rpc", "not an object"},
                      BadConfig{R"({"rpc": {"port": 1, "port": 2}})", "", "'port' stands twice"},
                      BadConfig{R"({"rpc": {"port": 1.5}})", "/rpc/port", "1.5"},
                      BadConfig{R"({"rpc": {"port": "1"}})", "/rpc/port", "integer"},
                      BadConfig{R"({"rpc": {"port": null}})", "/rpc/port", "integer"},
                      BadConfig{R"({"rpc": {"port": 18446744073709551615}})", "/rpc/port", "integer"},
                      BadConfig{R"({"rpc": {"port": -1}})", "/rpc/port", "0..65535"},
                      BadConfig{R"({"stage": {"min_um": 1e999}})", "", "no valid JSON"},
                      BadConfig{R"({"stage": {"min_um": NaN}})", "", "no valid JSON"},
                      BadConfig{R"({"stage": {"speed_um_per_s": 0}})", "/stage/speed_um_per_s", "above 0"},
                      BadConfig{R"({"stage": {"simulated": 1}})", "/stage/simulated", "true or false"},
                      BadConfig{R"({"camera": {"driver": "usb"}})", "/camera/driver", "\"aravis\", \"replay\""},
                      BadConfig{R"({"objectives": {}})", "/objectives", "a list"},
                      BadConfig{R"({"objectives": [{"na": 0.4, "magnification": 20, "working_distance_mm": 11}]})",
                                "/objectives/0/name", "missing"},
                      BadConfig{R"({"objectives": [{"name": "a", "na": 1.71, "magnification": 20,
                                                    "working_distance_mm": 11}]})",
                                "/objectives/0/na", "1.71"},
                      BadConfig{R"({"objectives": [{"name": "a", "na": 0.4, "magnification": 0,
                                                    "working_distance_mm": 11}]})",
                                "/objectives/0/magnification", "above 0"},
                      BadConfig{R"({"objectives": [{"name": "a", "na": 0.4, "magnification": 20,
                                                    "working_distance_mm": 11, "min": 3}]})",
                                "/objectives/0/min", "unknown key"},
                      BadConfig{R"({"temperature": {"max_age_s": 0}})", "/temperature/max_age_s", "1..604800"},
                      BadConfig{R"({"a/b~c": 1})", "/a~1b~0c", "unknown key"},
                      BadConfig{"{\"rpc\": {\"address\": \"\xff\"}}", "", "no valid JSON"},
                      BadConfig{std::string(100, '['), "", "deeper"}),
    [](const auto& of) { return test::readable_name(of.index, of.param.pointer + " " + of.param.says); });

TEST(ConfigFile, PutsOverridesOverTheFile) {
  const LoadedConfig loaded = parse_config(R"({"rpc": {"port": 1}})", "/etc/fvd",
                                           {"rpc.port=0", "camera.address=10.0.0.7", "stage.simulated=true",
                                            "stage.min_um=-3.5", "camera.driver=\"replay\""});

  EXPECT_THAT(loaded.problems, IsEmpty());
  EXPECT_EQ(loaded.config.rpc.port, 0);
  EXPECT_EQ(loaded.config.camera.address, "10.0.0.7");
  EXPECT_TRUE(loaded.config.stage.simulated);
  EXPECT_EQ(loaded.config.stage.min, Micrometers{-3.5});
  EXPECT_EQ(loaded.config.camera.driver, "replay");
}

TEST(ConfigFile, ChecksOverridesLikeTheFile) {
  EXPECT_THAT(problems_of("{}", {"rpc.port=70000"}), ElementsAre(problem("/rpc/port", "70000")));
  EXPECT_THAT(problems_of("{}", {"rpc.prot=1"}), ElementsAre(problem("/rpc/prot", "did you mean")));
}

TEST(ConfigFile, RefusesMalformedOverrides) {
  for (const std::string text : {"rpc.port", "=1", ".port=1", "rpc.=1", "rpc..port=1"}) {
    EXPECT_THAT(problems_of("{}", {text}), ElementsAre(problem("", "expected group.key=value"))) << text;
  }
  EXPECT_THAT(problems_of(R"({"rpc": 5})", {"rpc.port=1"}), Contains(problem("", "'rpc' is no group")));
}

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

TEST(ConfigFile, KnowsFourRoles) {
  EXPECT_THAT(problems_of(R"({"rpc": {"loopback_role": "none", "allow": [{"address": "10.0.0.7", "role": "root"}],
                              "groups": [{"group": "line"}]}})"),
              ::testing::UnorderedElementsAre(problem("/rpc/loopback_role"), problem("/rpc/allow/0/role"),
                                              problem("/rpc/groups/0/role")));
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
  EXPECT_THAT(check_config(config_), ElementsAre(problem("/stage/min_um", "not below max_um")));
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

TEST(ConfigFile, SaysThatAFileCannotBeRead) {
  const test::ScratchDir folder;
  EXPECT_THAT(load_config(folder.path() / "absent.json").problems, ElementsAre(problem("", "absent.json")));
  EXPECT_THAT(load_config(folder.path()).problems, ElementsAre(problem("", "it is a folder")));
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

TEST(ConfigFile, ReportsRangesAndCrossFieldProblemsTogether) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "fvd.json";
  std::ofstream(file) << R"({"rpc": {"port": -1}, "stage": {"min_um": 5, "max_um": 4}, "camera": {"address": 7}})";

  const Problems problems = load_config(file).problems;

  EXPECT_THAT(problems, Contains(problem("/rpc/port")));
  EXPECT_THAT(problems, Contains(problem("/stage/min_um")));
  EXPECT_THAT(problems, Contains(problem("/camera/address", "expected a text")));
  EXPECT_THAT(problems, Not(Contains(problem("/camera/address", "is empty")))) << "said once is enough";
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

}  // namespace
}  // namespace fvd
