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
#include "core/runtime/worker_pool.hpp"
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
  const auto frequency = [](int i) {  // radians per pixel
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
  double rms_um = 0.0;       // of height minus truth, nothing removed
  double valid = 0.0;        // fraction
  double sigma_ratio = 0.0;  // of the RMS that sigma predicts to the one there is
  std::array<double, kPlateaus_um.size()> mean_um{};
};

Figures compare(const HeightMap& map) {
  Figures figures;
  double squares = 0.0;
  double predicted = 0.0;
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
        predicted += std::pow(static_cast<double>(map.sigma_m.at(column, y)) * 1e6, 2);
        sum += height_um;
        ++count;
      }
    }
    figures.mean_um[p] = sum / count;
    kept += count;
  }
  figures.rms_um = std::sqrt(squares / kept);
  figures.sigma_ratio = std::sqrt(predicted / squares);
  figures.valid = static_cast<double>(kept) / all;
  return figures;
}

class TheChapterScene : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    pool_ = std::make_unique<WorkerPool>(2);
    stack_ = scan(kStep_um, kSlices, {});
  }
  static std::unique_ptr<StreamingFocusStack> scan(double step_um, int slices, const FocusSettings& settings) {
    Scene scene;
    auto stack = std::make_unique<StreamingFocusStack>(Scene::kWidth, kSide_px, PixelFormat::kMono8, settings, *pool_);
    for (int k = 0; k < slices; ++k) {
      const double z_um = kFirst_um + step_um * k;
      stack->push(image_view(scene.slice(z_um).view(), PixelFormat::kMono8), z_um);
    }
    return stack;
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

TEST_F(TheChapterScene, IsMeasuredBetterTheBetterTheMethod) {
  struct Bound {
    PeakMethod method;
    double rms_um;
  };
  for (const auto& [method, rms_um] :
       {Bound{PeakMethod::kLogParabola, 0.40}, {PeakMethod::kInverseRoot, 0.25}, {PeakMethod::kFiveSample, 0.20}}) {
    SCOPED_TRACE(std::string(peak_method_name(method)));
    const Figures found = figures(method);
    EXPECT_LE(found.rms_um, rms_um);
    EXPECT_GE(found.rms_um, 0.09) << "below the bound of any unbiased method";
    EXPECT_NEAR(found.mean_um[1] - found.mean_um[0], 50.0, 0.1);
    EXPECT_NEAR(found.mean_um[2] - found.mean_um[1], 50.0, 0.1);
  }
  EXPECT_NEAR(figures(PeakMethod::kFiveSample).mean_um[0], 0.0, 0.1);
}

TEST_F(TheChapterScene, HasTheErrorsThatSigmaPredicts) {
  EXPECT_NEAR(figures(PeakMethod::kFiveSample).sigma_ratio, 1.0, 0.2);
}

TEST_F(TheChapterScene, IsMeasuredByAllSlicesOfAFineScanWithBins) {
  const double width_um = stack_->finish(PeakMethod::kFiveSample).curve_width_um;
  EXPECT_NEAR(width_um, 37.0, 3.0);
  constexpr double kFine_um = 2.5;
  const int bin = choose_bin_slices(kFine_um, width_um);
  EXPECT_EQ(bin, 5);
  const Figures without = compare(scan(kFine_um, 81, {})->finish(PeakMethod::kFiveSample));
  const Figures with = compare(scan(kFine_um, 81, {.bin_slices = bin})->finish(PeakMethod::kFiveSample));
  std::printf("step 2.5 um: %.3f um RMS, in bins of %d %.3f um; predicted over observed %.2f\n", without.rms_um, bin,
              with.rms_um, with.sigma_ratio);
  EXPECT_LT(with.rms_um, 0.5 * without.rms_um);
  EXPECT_NEAR(with.sigma_ratio, 1.0, 0.25);
}

TEST_F(TheChapterScene, IsValidEverywhere) { EXPECT_GE(figures(PeakMethod::kParabola).valid, 0.999); }

}  // namespace
}  // namespace fvd
