#include "daemon/config_reload.hpp"

#include <gmock/gmock.h>

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Reload after(const std::string& text) { return plan_reload(Config{}, parse_config(text, "")); }

TEST(ConfigReload, TakesTheLogLevel) {
  const Reload reload = after(R"({"log": {"level": "debug"}})");
  EXPECT_EQ(reload.refusal, "");
  EXPECT_THAT(reload.changes, ElementsAre("/log/level: info -> debug"));
}

TEST(ConfigReload, TakesWhatIsKeptOfResults) {
  const Reload reload = after(R"({"store": {"keep_days": 30, "keep_gib": 5, "keep_free_gib": 2}})");
  EXPECT_EQ(reload.refusal, "");
  EXPECT_THAT(reload.changes, ::testing::UnorderedElementsAre("/store/keep_days: 0 -> 30", "/store/keep_gib: 0 -> 5",
                                                              "/store/keep_free_gib: 0 -> 2"));
}

TEST(ConfigReload, TakesNothingWhereNothingDiffers) {
  const Reload reload = after("{}");
  EXPECT_EQ(reload.refusal, "");
  EXPECT_THAT(reload.changes, IsEmpty());
}

TEST(ConfigReload, TakesAllOrNothing) {
  const Reload reload = after(R"({"log": {"level": "debug"}, "rpc": {"port": 1}, "stage": {"min_um": -7}})");
  EXPECT_THAT(reload.refusal,
              AllOf(HasSubstr("/rpc/port"), HasSubstr("/stage/min_um"), HasSubstr("restart"), Not(HasSubstr("/log"))));
  EXPECT_THAT(reload.changes, IsEmpty());
}

TEST(ConfigReload, TakesNoListThatGrew) {
  const std::string one = R"({"name": "20x", "na": 0.4, "magnification": 20, "working_distance_mm": 11})";
  EXPECT_THAT(after("{\"objectives\": [" + one + "]}").refusal, HasSubstr("/objectives"));
}

TEST(ConfigReload, TakesNothingOfAFileThatIsRefused) {
  EXPECT_THAT(after(R"({"log": {"level": "loud"}})").refusal, HasSubstr("/log/level: \"loud\" is not accepted"));
  EXPECT_THAT(after("{").refusal, HasSubstr("no valid JSON"));
}

}  // namespace
}  // namespace fvd
