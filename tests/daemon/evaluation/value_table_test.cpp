/// The table of values holds every value that there is, and the README holds the table.

#include "daemon/evaluation/value_table.hpp"

#include <cstdlib>
#include <fstream>
#include <set>

#include <gmock/gmock.h>

#include "daemon/evaluation/value_names.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using Key = std::pair<std::string, std::string>;

void add_keys(const PlannedMeasurement& measurement, std::set<Key>& keys) {
  for (const std::string& key : value_keys(measurement)) keys.emplace(measurement.kind, key);
}

/// Of every kind with every method and parameter.
std::set<Key> all_keys() {
  std::set<Key> keys;
  PlannedMeasurement measurement;
  measurement.kind = "step_height";
  for (const char* method : {"iso5436_a1", "iso5436_a2"}) {
    measurement.method = method;
    add_keys(measurement, keys);
  }
  measurement.kind = "step_between";
  add_keys(measurement, keys);
  measurement.kind = "levels";
  measurement.regions = {"LOWER", "UPPER"};
  add_keys(measurement, keys);
  measurement.kind = "areal";
  measurement.parameters = areal_value_names();
  add_keys(measurement, keys);
  measurement.kind = "profile";
  measurement.parameters = profile_value_names();
  add_keys(measurement, keys);
  measurement.kind = "cutting_edge";
  measurement.chipping = PlannedChipping{};
  add_keys(measurement, keys);
  return keys;
}

TEST(TheTableOfValues, HasEachValueOnceWithMeaningAndOrigin) {
  std::multiset<Key> told;
  for (const ValueMeaning& value : value_meanings()) {
    told.emplace(value.kind, value.key);
    EXPECT_FALSE(value.meaning.empty()) << value.key;
    EXPECT_FALSE(value.defined.empty()) << value.key;
  }

  const std::set<Key> keys = all_keys();
  EXPECT_EQ(std::multiset<Key>(keys.begin(), keys.end()), told);
}

/// With FVD_WRITE_TABLES=1 in the environment the README is written instead of compared.
TEST(TheTableOfValues, StandsInTheReadme) {
  const std::filesystem::path file = FVD_SOURCE_DIR "/daemon/evaluation/README.md";
  const std::string readme = test::read_text(file);
  const std::string begin = "<!-- values: begin (FVD_WRITE_TABLES=1 evaluation_test) -->\n";
  const auto from = readme.find(begin);
  const auto to = readme.find("<!-- values: end -->\n");
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  const std::string wanted = readme.substr(0, from + begin.size()) + values_markdown() + readme.substr(to);
  if (std::getenv("FVD_WRITE_TABLES") != nullptr) std::ofstream(file) << wanted;

  EXPECT_TRUE(test::read_text(file) == wanted)
      << file << " does not hold the table of values: run evaluation_test with FVD_WRITE_TABLES=1";
}

}  // namespace
}  // namespace fvd
