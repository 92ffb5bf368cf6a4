// The generated and recorded stacks in ../shared/data beside the project.

#include <cmath>
#include <iostream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"

namespace fvd::ctl {
namespace {

using test::ScratchDir;
namespace fs = std::filesystem;

const fs::path kData = fs::path(FVD_SOURCE_DIR) / "../shared/data";

void process(const fs::path& stack, const fs::path& out, std::vector<std::string> options) {
  options.insert(options.begin(), {"process", stack.string(), "--out", out.string()});
  std::ostringstream output;
  std::ostringstream errors;
  ASSERT_EQ(run_fvdctl(options, {output, errors, false, false}), kExitOk) << errors.str();
  const auto result = nlohmann::json::parse(test::read_text(out / "result.json"));
  EXPECT_EQ(result["slices"]["suspect"], nlohmann::json::array()) << "a clean stack";
  EXPECT_LT(result["slices"]["flicker_percent"].get<double>(), 2.0);
}

struct Agreement {
  double rms_slices = 0.0;
  double worst_slices = 0.0;
  int points = 0;
  int with_truth = 0;
};

/// Over all points where the truth is known and the map is valid; no other mask.
Agreement compare(const fs::path& height_file, const fs::path& truth_file, double slices_per_metre,
                  double slices_per_truth) {
  const cv::Mat height = cv::imread(height_file.string(), cv::IMREAD_UNCHANGED);
  cv::Mat truth = cv::imread(truth_file.string(), cv::IMREAD_UNCHANGED);
  truth.convertTo(truth, CV_64F);
  Agreement agreement;
  double sum = 0.0;
  for (int y = 0; y < height.rows; ++y) {
    for (int x = 0; x < height.cols; ++x) {
      const double expected = truth.at<double>(y, x) * slices_per_truth;
      if (std::isnan(expected)) continue;
      ++agreement.with_truth;
      const double measured = static_cast<double>(height.at<float>(y, x)) * slices_per_metre;
      if (std::isnan(measured)) continue;
      ++agreement.points;
      sum += (measured - expected) * (measured - expected);
      agreement.worst_slices = std::max(agreement.worst_slices, std::abs(measured - expected));
    }
  }
  agreement.rms_slices = std::sqrt(sum / agreement.points);
  return agreement;
}

void expect_agreement(const Agreement& agreement) {
  std::cout << "rms " << agreement.rms_slices << " slices, worst " << agreement.worst_slices << ", valid "
            << 100.0 * agreement.points / agreement.with_truth << " %\n";
  EXPECT_LE(agreement.rms_slices, 0.2);
  EXPECT_GE(agreement.points, 0.99 * agreement.with_truth);
}

class AGeneratedStack : public testing::TestWithParam<const char*> {};

TEST_P(AGeneratedStack, AgreesWithItsTruthWithinAFifthOfASlice) {
  const fs::path folder = kData / GetParam();
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const ScratchDir scratch;
  process(folder, scratch / "out", {"--z-step-um", "1"});
  expect_agreement(compare(scratch / "out/height.tiff", folder / "truth.tiff", 1e6, 1.0));
}

INSTANTIATE_TEST_SUITE_P(Reference, AGeneratedStack, testing::Values("generated-cou1", "generated-cou6"));

TEST(TheGeneratedCone, AgreesWithItsTruthWithinAFifthOfASlice) {
  const fs::path folder = kData / "generated-cone31";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const ScratchDir scratch;
  process(folder, scratch / "out", {"--z-file", (folder / "z.txt").string(), "--z-unit", "m"});
  constexpr double kSlicesPerMetre = 1 / 0.002;
  expect_agreement(compare(scratch / "out/height.tiff", folder / "truth.tiff", kSlicesPerMetre, kSlicesPerMetre));
}

TEST(ThePhotographedPart, HasHeightsAndHonestHoles) {
  const fs::path folder = kData / "real-usb15";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const ScratchDir scratch;
  process(folder, scratch / "out", {"--z-step-um", "10"});
  const auto values = nlohmann::json::parse(test::read_text(scratch / "out/result.json"))["values"];
  EXPECT_GT(values["valid_fraction"].get<double>(), 0.1);
  EXPECT_LT(values["valid_fraction"].get<double>(), 0.9);
  EXPECT_GT(values["height"]["min_um"].get<double>(), 0.0);
  EXPECT_LT(values["height"]["max_um"].get<double>(), 140.0);
  // The matte band that runs through the upper right corner lies at one height.
  const cv::Mat height = cv::imread((scratch / "out/height.tiff").string(), cv::IMREAD_UNCHANGED);
  int valid = 0;
  int near = 0;
  for (int y = 220; y < 320; ++y) {
    for (int x = 1440; x < 1540; ++x) {
      const double z_um = static_cast<double>(height.at<float>(y, x)) * 1e6;
      valid += std::isnan(z_um) ? 0 : 1;
      near += std::abs(z_um - 98.0) < 10.0 ? 1 : 0;
    }
  }
  EXPECT_GT(valid, 9500);
  EXPECT_GT(near, 9500);
}

}  // namespace
}  // namespace fvd::ctl
