/// fvdctl measure with regions that are pictures.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_command;
using testing::HasSubstr;

/// A grey PNG of 8 bit, 4 x 3 points, of which the left half is 255.
constexpr unsigned char kMask[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00,
    0x04, 0x00, 0x00, 0x00, 0x03, 0x08, 0x00, 0x00, 0x00, 0x00, 0x91, 0x9f, 0xf1, 0x1a, 0x00, 0x00, 0x00, 0x10, 0x49,
    0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xff, 0x9f, 0x81, 0x81, 0x01, 0x4e, 0x00, 0x00, 0x32, 0xdc, 0x05, 0xfb,
    0x0c, 0x5d, 0xcf, 0xf9, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

constexpr const char* kRecipe = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 1, "slices": 11}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}},
  "evaluation": {"regions": {"left": {"mask_png": "left.png"}},
                 "measurements": {"part": {"kind": "areal", "region": "left", "parameters": ["Sz"]}}}})";

class Measure : public testing::Test {
 protected:
  Measure() {
    std::filesystem::create_directory(folder_ / "masks");
    test::write_text(folder_ / "masks/left.png", {reinterpret_cast<const char*>(kMask), sizeof kMask});
    test::write_text(folder_ / "part.json", kRecipe);
    test::write_text(folder_ / "map.csv", "# unit = um\n1,1,5,5\n1,1,5,9\n1,1,5,5\n");
  }
  [[nodiscard]] Outcome measure() const {
    return run_command({"measure", (folder_ / "map.csv").string(), "--recipe", (folder_ / "part.json").string(),
                        "--pitch-um", "1", "--json"});
  }
  test::ScratchDir folder_;
};

TEST_F(Measure, ReadsMasksBesideTheRecipe) {
  const Outcome outcome = measure();

  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  const json part = json::parse(outcome.out)["measurements"]["part"];
  EXPECT_EQ(part["points"], 6);
  EXPECT_EQ(part["values"]["Sz_um"]["value"], 0.0);
  EXPECT_EQ(part["details"]["mask_sha256"]["left.png"].get<std::string>().size(), 64U);
}

TEST_F(Measure, RefusesARecipeWhoseMaskIsNotThere) {
  std::filesystem::remove(folder_ / "masks/left.png");

  const Outcome outcome = measure();

  EXPECT_EQ(outcome.code, kExitConfig);
  EXPECT_THAT(outcome.err, HasSubstr("/evaluation/regions/left/mask_png: "));
  EXPECT_THAT(outcome.err, HasSubstr("masks/left.png: there is no such file"));
}

TEST_F(Measure, SaysInItsHelpWhereTheNamesOfValuesAre) {
  EXPECT_THAT(run_command({"measure", "--help"}).out, HasSubstr("daemon/evaluation/README.md"));
}

}  // namespace
}  // namespace fvd::ctl
