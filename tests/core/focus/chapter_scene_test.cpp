/// Known figures of the method on plateaus seen through a Gaussian defocus, drawn here without any of the simulator.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/pipeline/worker_pool.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

constexpr int kSide_px = 160;   // of a plateau
constexpr int kMargin_px = 12;  // keeps windows off the steps
constexpr int kSlices = 21;     // at -7 + 10 k um
constexpr double kFirst_um = -7.0;
constexpr double kStep_um = 10.0;
constexpr double kDefocus_px_per_um = 0.04;
constexpr double kReadoutNoise = 1.5;      // grey levels
constexpr double kTextureContrast = 28.0;  // grey levels, standard deviation
constexpr std::array kPlateaus_um{0.0, 50.0, 100.0};

/// The transfer of a Gaussian blur of sigma pixels at each frequency of a real kSide_px square.
cv::Mat gaussian_transfer(double sigma) {
  cv::Mat transfer(kSide_px, kSide_px, CV_64F);
  const auto frequency = [](int i) {  // radians a pixel
    return 2.0 * std::numbers::pi * (i <= kSide_px / 2 ? i : i - kSide_px) / kSide_px;
  };
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      const double squared = frequency(x) * frequency(x) + frequency(y) * frequency(y);
      transfer.at<double>(y, x) = std::exp(-0.5 * sigma * sigma * squared);
    }
  }
  return transfer;
}

/// Exact for a periodic image: the product with the transfer in the frequency domain.
cv::Mat blurred(const cv::Mat& image, double sigma) {
  cv::Mat spectrum;
  cv::dft(image, spectrum, cv::DFT_COMPLEX_OUTPUT);
  const cv::Mat transfer = gaussian_transfer(sigma);
  cv::Mat both;
  cv::merge(std::vector<cv::Mat>{transfer, transfer}, both);
  cv::Mat result;
  cv::idft(spectrum.mul(both), result, cv::DFT_REAL_OUTPUT | cv::DFT_SCALE);
  return result;
}

/// Granite as the simulated microscope's default world has it: grain sizes in pixels and their weights. The figures
/// depend on it; four equal weights of 0.5, 1, 2, 4 px put the parabola at 0.67 um and the log parabola at 0.38 um.
struct Grain {
  double sigma_px;
  double weight;
};
constexpr std::array<Grain, 4> kGrains{{{0.6, 0.80}, {1.2, 0.45}, {3.0, 0.30}, {8.0, 0.25}}};

/// Shape [kSide_px][kSide_px], zero mean, standard deviation kTextureContrast.
cv::Mat granite(cv::RNG& random) {
  cv::Mat sum(kSide_px, kSide_px, CV_64F, cv::Scalar(0));
  for (const Grain& grain : kGrains) {
    cv::Mat noise(kSide_px, kSide_px, CV_64F);
    random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    const cv::Mat grains = blurred(noise, grain.sigma_px);
    sum += grains * (grain.weight * kSide_px / cv::norm(grains));
  }
  sum -= cv::mean(sum);
  return sum * (kTextureContrast * kSide_px / cv::norm(sum));
}

/// The plateaus side by side, each a periodic texture of its own: shape [kSide_px][3 * kSide_px].
class Scene {
 public:
  Scene() {
    for (cv::Mat& texture : textures_) texture = granite(random_);
  }

  Plane<std::uint8_t> slice(double z_um) {
    Plane<std::uint8_t> pixels(kWidth, kSide_px);
    for (std::size_t p = 0; p < kPlateaus_um.size(); ++p) {
      const cv::Mat seen = blurred(textures_[p], kDefocus_px_per_um * std::abs(z_um - kPlateaus_um[p]));
      for (int y = 0; y < kSide_px; ++y) {
        for (int x = 0; x < kSide_px; ++x) {
          const double level = 128.0 + seen.at<double>(y, x) + random_.gaussian(kReadoutNoise);
          pixels.at(static_cast<int>(p) * kSide_px + x, y) = cv::saturate_cast<std::uint8_t>(level);
        }
      }
    }
    return pixels;
  }

  static constexpr int kWidth = kSide_px * static_cast<int>(kPlateaus_um.size());

 private:
  cv::RNG random_{20260101};
  std::array<cv::Mat, kPlateaus_um.size()> textures_;
};

struct Figures {
  double rms_um = 0.0;  // of height minus truth, nothing removed
  double valid = 0.0;   // fraction
  std::array<double, kPlateaus_um.size()> mean_um{};
};

Figures compare(const HeightMap& map) {
  Figures figures;
  double squares = 0.0;
  int all = 0;
  int kept = 0;
  for (std::size_t p = 0; p < kPlateaus_um.size(); ++p) {
    double sum = 0.0;
    int count = 0;
    for (int y = kMargin_px; y < kSide_px - kMargin_px; ++y) {
      for (int x = kMargin_px; x < kSide_px - kMargin_px; ++x) {
        ++all;
        const int column = static_cast<int>(p) * kSide_px + x;
        if (map.mask.at(column, y) != 0) continue;
        const double height_um = static_cast<double>(map.height_m.at(column, y)) * 1e6;
        squares += std::pow(height_um - kPlateaus_um[p], 2);
        sum += height_um;
        ++count;
      }
    }
    figures.mean_um[p] = sum / count;
    kept += count;
  }
  figures.rms_um = std::sqrt(squares / kept);
  figures.valid = static_cast<double>(kept) / all;
  return figures;
}

class TheChapterScene : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Scene scene;
    pool_ = std::make_unique<WorkerPool>(2);
    stack_ = std::make_unique<StreamingFocusStack>(Scene::kWidth, kSide_px, PixelFormat::kMono8,
                                                   FocusSettings{.window_px = 9, .min_prominence = 0.5}, *pool_);
    for (int k = 0; k < kSlices; ++k) {
      const double z_um = kFirst_um + kStep_um * k;
      stack_->push(image_view(scene.slice(z_um).view(), PixelFormat::kMono8), z_um);
    }
  }
  static void TearDownTestSuite() {
    stack_.reset();
    pool_.reset();
  }

  static Figures figures(PeakMethod method) {
    const Figures result = compare(stack_->finish(method));
    std::printf("%s: %.3f um RMS, plateaus at %.3f %.3f %.3f um, %.2f %% valid\n",
                std::string(peak_method_name(method)).c_str(), result.rms_um, result.mean_um[0], result.mean_um[1],
                result.mean_um[2], 100.0 * result.valid);
    return result;
  }

  static inline std::unique_ptr<WorkerPool> pool_;
  static inline std::unique_ptr<StreamingFocusStack> stack_;
};

TEST_F(TheChapterScene, IsOffByThreeMicrometersAtTheNearestSlice) {
  EXPECT_NEAR(figures(PeakMethod::kNearest).rms_um, 3.0, 0.05);
}

TEST_F(TheChapterScene, IsMeasuredByTheParabola) {
  const Figures parabola = figures(PeakMethod::kParabola);
  EXPECT_LE(parabola.rms_um, 0.65);
  EXPECT_GE(parabola.rms_um, 0.2) << "better than the method can be: the scene is not what it should be";
}

TEST_F(TheChapterScene, IsMeasuredBetterByTheLogParabola) {
  const Figures log_parabola = figures(PeakMethod::kLogParabola);
  EXPECT_LE(log_parabola.rms_um, 0.40);
  EXPECT_GE(log_parabola.rms_um, 0.09) << "below the bound of any unbiased method";
  EXPECT_NEAR(log_parabola.mean_um[1] - log_parabola.mean_um[0], 50.0, 0.1);
  EXPECT_NEAR(log_parabola.mean_um[2] - log_parabola.mean_um[1], 50.0, 0.1);
}

TEST_F(TheChapterScene, IsMeasuredBetterStillByTheInverseRoot) {
  const Figures inverse_root = figures(PeakMethod::kInverseRoot);
  EXPECT_LE(inverse_root.rms_um, 0.25);
  EXPECT_GE(inverse_root.rms_um, 0.09) << "below the bound of any unbiased method";
  EXPECT_NEAR(inverse_root.mean_um[1] - inverse_root.mean_um[0], 50.0, 0.1);
  EXPECT_NEAR(inverse_root.mean_um[2] - inverse_root.mean_um[1], 50.0, 0.1);
}

TEST_F(TheChapterScene, IsMeasuredBestOfAllByFiveSamples) {
  const Figures five = figures(PeakMethod::kFiveSample);
  EXPECT_LE(five.rms_um, 0.20);
  EXPECT_NEAR(five.mean_um[0], 0.0, 0.1);
  EXPECT_NEAR(five.mean_um[1] - five.mean_um[0], 50.0, 0.1);
  EXPECT_NEAR(five.mean_um[2] - five.mean_um[1], 50.0, 0.1);
}

TEST_F(TheChapterScene, IsValidEverywhere) { EXPECT_GE(figures(PeakMethod::kParabola).valid, 0.999); }

}  // namespace
}  // namespace fvd
