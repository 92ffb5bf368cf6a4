#include "daemon/config/config_file.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/config/problem_matcher.hpp"
#include "tests/support/readable_name.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::problem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

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

TEST(ConfigFile, SaysThatAFileCannotBeRead) {
  const test::ScratchDir folder;
  EXPECT_THAT(load_config(folder.path() / "absent.json").problems, ElementsAre(problem("", "absent.json")));
  EXPECT_THAT(load_config(folder.path()).problems, ElementsAre(problem("", "it is a folder")));
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

TEST(ConfigFile, KnowsFourRoles) {
  EXPECT_THAT(problems_of(R"({"rpc": {"loopback_role": "none", "allow": [{"address": "10.0.0.7", "role": "root"}],
                              "groups": [{"group": "line"}]}})"),
              ::testing::UnorderedElementsAre(problem("/rpc/loopback_role"), problem("/rpc/allow/0/role"),
                                              problem("/rpc/groups/0/role")));
}

}  // namespace
}  // namespace fvd
