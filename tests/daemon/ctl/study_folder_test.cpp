/// fvdctl verify and calibrate on folders of results, without a daemon.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/units.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/export/result_writer.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_command;
using testing::HasSubstr;

class AStudyOfFolders : public testing::Test {
 protected:
  /// A result of 300 x 240 points at 0.5 um; um(column, row).
  template <typename HeightUm>
  std::string folder_of(const std::string& id, HeightUm um) const {
    ResultData data = test::sample_result();
    data.job_id = id;
    data.pixel_pitch_x_um = data.pixel_pitch_y_um = 0.5;
    data.exports = std::vector<std::string>{"tiff"};
    data.map = test::sample_map(300, 240);
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 300; ++x) {
        data.map.height_m.at(x, y) = static_cast<float>(um(x, y) * kMetresPerMicrometer);
      }
    }
    write_result(scratch_ / id, data);
    return (scratch_ / id).string();
  }
  /// Lines 16 columns wide every 80, their edges 6 wide.
  static double grid_um(int x, int y) {
    const auto share = [](double from_middle) { return std::clamp((11.0 - std::abs(from_middle)) / 6.0, 0.0, 1.0); };
    const double across = share(std::remainder(x - 40.0, 80.0));
    const double along = share(std::remainder(y - 40.0, 80.0));
    return 40.0 + 10.0 * std::max(across, along);
  }
  /// What a study may leave beside the results that it read.
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::recursive_directory_iterator(scratch_.path()), {}));
  }
  test::ScratchDir scratch_;
};

TEST_F(AStudyOfFolders, PrintsThePitchAndKeepsNothing) {
  const std::string folder = folder_of("grid", grid_um);
  const std::size_t before = entries();

  const Outcome outcome =
      run_command({"calibrate", "lateral", "--folder", folder, "--grid-pitch-um", "40.04", "--json"});

  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  const json reply = json::parse(outcome.out);
  EXPECT_EQ(reply["kept"], false);
  EXPECT_EQ(reply["study"]["kind"], "calibrate.lateral");
  EXPECT_EQ(reply["study"]["jobs"], json{folder});
  ASSERT_EQ(reply["study"]["figures"][0]["name"], "pitch_x_um");
  EXPECT_NEAR(reply["study"]["figures"][0]["value"].get<double>(), 40.04 / 80.0, 1e-5);
  EXPECT_THAT(outcome.err, HasSubstr("nothing is kept"));
  EXPECT_EQ(entries(), before);
}

TEST_F(AStudyOfFolders, TellsPeopleThatNothingIsKept) {
  const std::string folder = folder_of("grid", grid_um);

  const Outcome outcome = run_command({"calibrate", "lateral", "--folder", folder, "--grid-pitch-um", "30"});

  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("pitch_y_um"), HasSubstr("nothing is kept")));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("accept")));
}

TEST_F(AStudyOfFolders, TakesSeveralFolders) {
  const std::string up = folder_of("up", [](int x, int y) { return 0.2 * ((3 * x + y) % 5); });
  const std::string more = folder_of("more", [](int x, int y) { return 0.2 * ((3 * x + y) % 7); });

  EXPECT_EQ(run_command({"verify", "noise", "--folder", up, more}).code, kExitOk);
  const Outcome hysteresis = run_command({"verify", "hysteresis", "--folder", up, more});

  EXPECT_EQ(hysteresis.code, kExitBadData);
  EXPECT_THAT(hysteresis.err, HasSubstr("was not scanned downwards"));
}

TEST_F(AStudyOfFolders, RefusesWithTheExitCodeOfItsReason) {
  const std::string flat = folder_of("flat", [](int, int) { return 1.0; });
  const auto code = [](std::vector<std::string> arguments) { return run_command(arguments).code; };

  EXPECT_EQ(code({"calibrate", "lateral", "--folder", flat, "--grid-pitch-um", "40"}), kExitBadData);
  EXPECT_EQ(code({"calibrate", "lateral", "--folder", flat, "--grid-pitch-um", "-1"}), kExitBadData);
  EXPECT_EQ(code({"calibrate", "lateral", "--folder", flat}), kExitUsage);
  EXPECT_EQ(code({"calibrate", "lateral", "job", "--folder", flat, "--grid-pitch-um", "40"}), kExitUsage);
  EXPECT_EQ(code({"calibrate", "lateral", "--folder", (scratch_ / "none").string(), "--grid-pitch-um", "40"}),
            kExitUsage);
  EXPECT_EQ(code({"verify", "sphere", "--folder", flat, flat, "--radius-um", "40"}), kExitUsage);
  EXPECT_EQ(code({"verify", "resolution", "--folder", flat, "--artefact", "stair"}), kExitUsage);
  EXPECT_EQ(code({"verify", "step", "--offline", "--step", flat + "=50,0.01"}), kExitBadData) << "it measured nothing";
  EXPECT_EQ(code({"gauge", "type1", "--folder", flat, flat, "--reference", "1", "--tolerance", "1"}), kExitBadData);
  // Of as many scans as a study would refuse, none is begun.
  EXPECT_EQ(code({"verify", "noise", "--part", "p", "--scans", "1"}), kExitUsage);
  EXPECT_EQ(code({"verify", "noise", "--part", "p", "--scans", "21"}), kExitUsage);
  EXPECT_EQ(code({"gauge", "type1", "--part", "p", "--scans", "1", "--reference", "1", "--tolerance", "1"}),
            kExitUsage);
}

}  // namespace
}  // namespace fvd::ctl
