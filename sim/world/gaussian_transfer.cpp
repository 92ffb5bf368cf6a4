#include "sim/world/gaussian_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/core.hpp>

namespace fvd::sim {

namespace {

constexpr double kFirstSpacing = 0.04;
constexpr double kSpacingGrowth = 1.25;

/// Angular frequency of bin k of n, -pi..pi.
double frequency(int k, int n) { return 2.0 * std::numbers::pi * (k <= n / 2 ? k : k - n) / n; }

}  // namespace

TransferNodes::TransferNodes(double sigma_max) {
  const double t_max = sigma_max * sigma_max;
  for (int i = 0; i <= 4; ++i) t_.push_back(kFirstSpacing * i);
  while (t_.back() < t_max) t_.push_back(t_.back() * kSpacingGrowth);
  t_.push_back(t_.back() * kSpacingGrowth);  // so that four nodes surround the largest blur
}

TransferWeights TransferNodes::at(double sigma) const {
  const int last = static_cast<int>(t_.size()) - 1;
  const double t = std::min(sigma * sigma, t_[static_cast<std::size_t>(last - 1)]);
  const int above = static_cast<int>(std::upper_bound(t_.begin(), t_.end(), t) - t_.begin());
  TransferWeights result;
  result.first = std::clamp(above - 2, 0, last - 3);
  for (int i = 0; i < 4; ++i) {
    double weight = 1.0;
    for (int j = 0; j < 4; ++j) {
      if (j == i) continue;
      const double ti = t_[static_cast<std::size_t>(result.first) + static_cast<std::size_t>(i)];
      const double tj = t_[static_cast<std::size_t>(result.first) + static_cast<std::size_t>(j)];
      weight *= (t - tj) / (ti - tj);
    }
    result.weight[static_cast<std::size_t>(i)] = static_cast<float>(weight);
  }
  return result;
}

FrequencyBlur::FrequencyBlur(const Plane<float>& image) : width_(image.width()), height_(image.height()) {
  spectrum_.resize(2 * image.pixels().size());
  const cv::Mat input(height_, width_, CV_32F, const_cast<float*>(image.row(0)));  // read only
  cv::Mat output(height_, width_, CV_32FC2, spectrum_.data());
  cv::dft(input, output, cv::DFT_COMPLEX_OUTPUT);
}

Plane<float> FrequencyBlur::blurred(double t) const {
  std::vector<float> across(static_cast<std::size_t>(width_));
  for (int x = 0; x < width_; ++x) {
    const double u = frequency(x, width_);
    across[static_cast<std::size_t>(x)] = static_cast<float>(std::exp(-0.5 * t * u * u));
  }
  std::vector<float> product(spectrum_.size());
  for (int y = 0; y < height_; ++y) {
    const double v = frequency(y, height_);
    const auto down = static_cast<float>(std::exp(-0.5 * t * v * v));
    const std::size_t row = 2 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (std::size_t x = 0; x < across.size(); ++x) {
      product[row + 2 * x] = spectrum_[row + 2 * x] * across[x] * down;
      product[row + 2 * x + 1] = spectrum_[row + 2 * x + 1] * across[x] * down;
    }
  }
  Plane<float> image(width_, height_);
  const cv::Mat input(height_, width_, CV_32FC2, product.data());
  cv::Mat output(height_, width_, CV_32F, image.row(0));
  cv::dft(input, output, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return image;
}

}  // namespace fvd::sim
