#include <cmath>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kWidth = 250;
constexpr int kHeight = 240;
constexpr int kSlices = 11;
constexpr int kMiddle = 5;
/// The surface rises from 38 to 62 um along x.
double height_um(double x) { return 38.0 + 24.0 * x / kWidth; }

/// Slices 10 um apart. Each pixel is the mean of the texture over a box about it that grows with its defocus; the
/// object, and its texture with it, moves right by so many pixels per slice.
void write_drifting(const fs::path& folder, int px_per_slice) {
  constexpr int kRoom = 60;
  constexpr int kWide = kWidth + 2 * kRoom;
  constexpr int kHigh = kHeight + 2 * kRoom;
  std::mt19937 random(4);
  cv::Mat sums(kHigh + 1, kWide + 1, CV_64F, cv::Scalar(0));
  for (int y = 0; y < kHigh; ++y) {
    for (int x = 0; x < kWide; ++x) {
      sums.at<double>(y + 1, x + 1) = sums.at<double>(y, x + 1) + sums.at<double>(y + 1, x) - sums.at<double>(y, x) +
                                      static_cast<double>(random() % 200U) + 28.0;
    }
  }
  fs::create_directories(folder);
  for (int k = 0; k < kSlices; ++k) {
    const int shift = px_per_slice * (k - kMiddle);
    cv::Mat slice(kHeight, kWidth, CV_8U);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double reach = 1.0 + 0.15 * std::abs(10.0 * k - height_um(x - shift));
        const int whole = static_cast<int>(reach);
        const auto mean = [&](int side) {
          const int left = x - shift + kRoom - side / 2;
          const int top = y + kRoom - side / 2;
          const double sum = sums.at<double>(top + side, left + side) - sums.at<double>(top, left + side) -
                             sums.at<double>(top + side, left) + sums.at<double>(top, left);
          return sum / (side * side);
        };
        const double part = reach - whole;
        const double level = (1.0 - part) * mean(2 * whole - 1) + part * mean(2 * whole + 1);
        slice.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(level + 0.5);
      }
    }
    cv::imwrite((folder / ("s" + std::to_string(10 + k) + ".png")).string(), slice);
  }
}

class ADriftingStack : public testing::Test {
 protected:
  static constexpr int kPxPerSlice = 2;
  ADriftingStack() { write_drifting(scratch_ / "in", kPxPerSlice); }

  Json processed(std::vector<std::string> more, const std::string& out, const std::string& in = "in") {
    std::vector<std::string> arguments{"process", scratch_ / in, "--out", scratch_ / out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::ostringstream text;
    std::ostringstream err;
    EXPECT_EQ(run_fvdctl(arguments, {text, err, false, false}), kExitOk) << err.str();
    said_ = text.str();
    return Json::parse(test::read_text(scratch_ / out / "result.json"));
  }

  /// RMS difference of the heights that are valid in both.
  [[nodiscard]] double difference_um(const std::string& one, const std::string& other) const {
    const auto heights = [this](const std::string& out) {
      return cv::imread((scratch_ / out / "height.tiff").string(), cv::IMREAD_UNCHANGED);
    };
    const cv::Mat a = heights(one);
    const cv::Mat b = heights(other);
    double squares = 0.0;
    int points = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double difference = 1e6 * static_cast<double>(a.at<float>(y, x) - b.at<float>(y, x));
        if (std::isnan(difference)) continue;
        squares += difference * difference;
        ++points;
      }
    }
    EXPECT_GT(points, kWidth * kHeight / 2);
    return std::sqrt(squares / points);
  }

  static std::vector<std::string> codes(const Json& result) {
    std::vector<std::string> codes;
    for (const Json& warning : result["warnings"]) codes.push_back(warning["code"]);
    return codes;
  }

  test::ScratchDir scratch_;
  std::string said_;
};

TEST_F(ADriftingStack, IsMeasuredAndLeftAsItIs) {
  const Json result = processed({"--z-step-um", "10"}, "out");

  const Json& drift = result["slices"]["drift_px"];
  EXPECT_NEAR(drift["x"].get<double>(), kPxPerSlice * (kSlices - 1), 0.5);
  EXPECT_NEAR(drift["y"].get<double>(), 0.0, 0.5);
  EXPECT_NEAR(drift["x_per_um"].get<double>(), 0.1 * kPxPerSlice, 0.005);
  EXPECT_EQ(drift["undone"], "nothing");
  EXPECT_THAT(codes(result), Contains("lateral_drift"));
  EXPECT_THAT(said_, HasSubstr("the image drifts by"));
  EXPECT_EQ(result["values"]["hole_points"]["out_of_view"], 0);
}

TEST_F(ADriftingStack, IsPutBackByWhatItsSlicesShow) {
  (void)processed({"--z-step-um", "10", "--drift", "off"}, "off");

  const Json result = processed({"--z-step-um", "10", "--drift", "auto"}, "auto");

  EXPECT_EQ(result["slices"]["drift_px"]["undone"], "slices");
  EXPECT_THAT(said_,
              testing::ContainsRegex("drift     0\\.[0-9]+, -?0\\.[0-9]+ px/um undone; [0-9.]+ % of the points are "
                                     "not in every slice"));
  EXPECT_NEAR(result["slices"]["drift_px"]["x"].get<double>(), kPxPerSlice * (kSlices - 1), 0.5);
  EXPECT_THAT(codes(result), Not(Contains("lateral_drift")));
  write_drifting(scratch_ / "still", 0);
  (void)processed({"--z-step-um", "10"}, "still_out", "still");
  EXPECT_LT(difference_um("auto", "still_out"), 0.02) << "a drift of whole pixels leaves no trace";
  EXPECT_GT(difference_um("off", "still_out"), 0.1);
  // What left the image on either side, and the reach of window and operator.
  const int hidden = 2 * (kMiddle * kPxPerSlice + 4 + 2) * kHeight;
  EXPECT_EQ(result["values"]["hole_points"]["out_of_view"], hidden);
}

TEST_F(ADriftingStack, IsPutBackByTheRecipe) {
  test::write_text(scratch_ / "part.json", R"({"format": 2,
    "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 11}, "camera": {"drift_px_per_um_x": 0.2}},
    "reconstruct": {"focus": {"stage_correction": false}}})");
  (void)processed({"--z-step-um", "10", "--drift", "auto"}, "auto");

  const Json result = processed({"--recipe", scratch_ / "part.json"}, "recipe");

  EXPECT_EQ(result["slices"]["drift_px"]["undone"], "recipe");
  EXPECT_NEAR(result["slices"]["drift_px"]["x_per_um"].get<double>(), 0.2, 0.005) << "of the slices as they came";
  EXPECT_THAT(codes(result), Not(Contains("lateral_drift")));
  EXPECT_LT(difference_um("recipe", "auto"), 1e-6);
  const Json off = processed({"--recipe", scratch_ / "part.json", "--drift", "off"}, "off");
  EXPECT_EQ(off["slices"]["drift_px"]["undone"], "nothing");
  EXPECT_THAT(codes(off), testing::IsSupersetOf({"lateral_drift", "recipe_overridden"}));
}

}  // namespace
}  // namespace fvd::ctl
