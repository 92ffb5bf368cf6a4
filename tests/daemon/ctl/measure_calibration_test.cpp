/// fvdctl measure with the constants of an instrument.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/calibration/calibration_book.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/export/gsf.hpp"
#include "daemon/export/result_writer.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::Outcome;
using test::run_command;
using test::ScratchDir;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kMean = R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 2, "pixel_pitch_y_um": 4}},
  "evaluation": {"measurements": {"t": {"kind": "areal", "parameters": ["Sz"]}}}})";
constexpr const char* kFlattened = R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 2, "pixel_pitch_y_um": 4}},
  "evaluation": {"surfaces": {"s": {"steps": [{"op": "flatness_reference"}]}},
    "measurements": {"t": {"kind": "areal", "surface": "s", "parameters": ["Sz"], "limits": {"Sz_um": {"upper": 900}}}}}})";

class AMeasuredSurface : public testing::Test {
 protected:
  AMeasuredSurface() {
    test::write_text(scratch_ / "mean.json", kMean);
    test::write_text(scratch_ / "flattened.json", kFlattened);
    test::write_text(scratch_ / "part.gsf", encode_gsf(heights(), {"part", 2.0, 4.0, {}}));
    accept("", 1.25, "");
    accept("10x", 1.6, "2020-01-01");
  }

  /// height[y][x] = x + 10 y um: Sz is 25 um.
  static Plane<float> heights() { return test::sample_map().height_m.clone(); }

  Calibration accept(const std::string& objective, double alpha_z, const std::string& renew_by) {
    return CalibrationBook(scratch_ / "calibration").add(objective, [&](Calibration& next) {
      next.z = ZConstants{alpha_z, 0.001, 0.05, 0.0, 0.0, {}};
      next.z->origin.renew_by = renew_by;
      next.flatness = FlatnessConstants{0.1, 0.01, next.id + "-flatness.gsf", {}};
      return std::vector<CalibrationFile>{{next.flatness->reference, encode_gsf(heights(), {"flat", 2.0, 4.0, {}})}};
    });
  }

  Outcome measure(const std::string& source, const std::string& recipe, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"measure", (scratch_ / source).string(), "--recipe",
                                       (scratch_ / recipe).string(), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_command(arguments);
  }

  static nlohmann::json measurement(const Outcome& outcome) {
    return nlohmann::json::parse(outcome.out)["measurements"]["t"];
  }

  [[nodiscard]] std::string folder() const { return (scratch_ / "calibration").string(); }

  ScratchDir scratch_;
};

TEST_F(AMeasuredSurface, FromAFileHasTheNewestConstantsOfTheObjective) {
  const Outcome plain = measure("part.gsf", "mean.json");
  const Outcome unnamed = measure("part.gsf", "mean.json", {"--calibration", folder()});
  const Outcome ten = measure("part.gsf", "mean.json", {"--calibration", folder(), "--objective", "10x"});

  EXPECT_EQ(nlohmann::json::parse(plain.out)["calibration"], "none");
  EXPECT_NEAR(measurement(plain)["values"]["Sz_um"]["value"].get<double>(), 25.0, 1e-4);
  EXPECT_NEAR(measurement(unnamed)["values"]["Sz_um"]["value"].get<double>(), 20.0, 1e-4);
  EXPECT_EQ(nlohmann::json::parse(ten.out)["calibration"], "cal-0002");
  EXPECT_NEAR(measurement(ten)["values"]["Sz_um"]["value"].get<double>(), 15.625, 1e-4);
  EXPECT_THAT(unnamed.err, Not(HasSubstr("renewed")));
  EXPECT_THAT(ten.err, HasSubstr("cal-0002 is past the day to be renewed by: z"));
}

TEST_F(AMeasuredSurface, FromAFileIsFlattenedByTheReferenceMap) {
  const Outcome without = measure("part.gsf", "flattened.json");
  const Outcome with = measure("part.gsf", "flattened.json", {"--calibration", folder()});

  EXPECT_EQ(without.code, ctl::kExitVerdictInvalid);
  EXPECT_EQ(measurement(without)["reason_code"], 1143);
  EXPECT_NEAR(measurement(with)["values"]["Sz_um"]["value"].get<double>(), 0.0, 1e-4);
}

TEST_F(AMeasuredSurface, IsNotMeasuredWithConstantsThatAreNotThere) {
  const Outcome objective = measure("part.gsf", "mean.json", {"--calibration", folder(), "--objective", "50x"});
  const Outcome alone = measure("part.gsf", "mean.json", {"--objective", "10x"});
  test::write_text(scratch_ / "calibration/calibration.json", "{}");
  const Outcome damaged = measure("part.gsf", "mean.json", {"--calibration", folder()});

  EXPECT_EQ(objective.code, ctl::kExitUsage);
  EXPECT_THAT(objective.err, HasSubstr("50x"));
  EXPECT_EQ(alone.code, ctl::kExitUsage);
  EXPECT_EQ(damaged.code, ctl::kExitBadData);
  EXPECT_THAT(damaged.err, HasSubstr("calibration.json"));
}

TEST_F(AMeasuredSurface, OfAResultHasTheConstantsOfTheResult) {
  ResultData data = test::sample_result();
  data.calibration = CalibrationBook(scratch_ / "calibration").find("cal-0001");
  write_result(scratch_ / "job", data);
  accept("", 1.5, "");  // later

  const Outcome alone = measure("job", "mean.json");
  const Outcome no_map = measure("job", "flattened.json");
  const Outcome flattened = measure("job", "flattened.json", {"--calibration", folder()});

  EXPECT_EQ(nlohmann::json::parse(alone.out)["calibration"], "cal-0001");
  EXPECT_EQ(measurement(no_map)["reason_code"], 1143);
  EXPECT_THAT(measurement(no_map)["reason"].get<std::string>(), HasSubstr("--calibration"));
  EXPECT_EQ(nlohmann::json::parse(flattened.out)["calibration"], "cal-0001");
  EXPECT_NEAR(measurement(flattened)["values"]["Sz_um"]["value"].get<double>(), 0.0, 1e-4);
}

TEST_F(AMeasuredSurface, OfAResultTakesNoMapOfAnotherInstrument) {
  ResultData data = test::sample_result();
  data.calibration = CalibrationBook(scratch_ / "calibration").find("cal-0001");
  data.calibration->z->alpha_z = 1.26;
  write_result(scratch_ / "job", data);

  const Outcome outcome = measure("job", "flattened.json", {"--calibration", folder()});

  EXPECT_EQ(outcome.code, ctl::kExitUsage);
  EXPECT_THAT(outcome.err, HasSubstr("another instrument"));
}

}  // namespace
}  // namespace fvd
