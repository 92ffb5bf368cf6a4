#include "core/focus/focus_suggestion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "core/base/error.hpp"
#include "core/focus/fit/row_fit.hpp"
#include "core/focus/measure/noise_probe.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

namespace {

constexpr double kMinResponseShare = 0.5;  // of the largest response
constexpr double kMaxNoiseShare = 0.03;    // of the peak
constexpr int kMaxWindow_px = 31;
constexpr int kMinSide_px = 32;

template <typename Pixel>
double mean_laplacian(PlaneView<const Pixel> image, int distance) {
  double sum = 0.0;
  double count = 0.0;
  for (int y = distance; y < image.height - distance; ++y) {
    for (int x = distance; x < image.width - distance; ++x) {
      const int centre = 2 * image.at(x, y);
      sum += std::abs(centre - image.at(x - distance, y) - image.at(x + distance, y)) +
             std::abs(centre - image.at(x, y - distance) - image.at(x, y + distance));
      count += 1.0;
    }
  }
  return sum / count;
}

double noise_in(const ImageView& image) {
  WorkerPool pool(1);
  NoiseProbe probe(image.width, image.height);
  probe.add(image, pool);
  return probe.least();
}

}  // namespace

FocusSuggestion suggest_focus(const ImageView& sharp, std::optional<double> noise_grey) {
  if (sharp.width < kMinSide_px || sharp.height < kMinSide_px) {
    throw Error(ErrorCode::kBadInput, "an image of " + std::to_string(sharp.width) + " x " +
                                          std::to_string(sharp.height) + " pixels: at least 32 x 32 are needed");
  }
  FocusSuggestion suggestion;
  suggestion.noise_grey = noise_grey ? *noise_grey : noise_in(sharp);
  // |2 I - I - I| of white noise is that of a normal distribution of 6 sigma^2, twice.
  const double of_noise = 2.0 * std::sqrt(2.0 / std::numbers::pi * 6.0) * suggestion.noise_grey;
  std::array<double, kMaxDistancePx> response{};
  for (int distance = 1; distance <= kMaxDistancePx; ++distance) {
    const double mean = sharp.format == PixelFormat::kMono8 ? mean_laplacian(sharp.as<std::uint8_t>(), distance)
                                                            : mean_laplacian(sharp.as<std::uint16_t>(), distance);
    // Texture and noise add as squares.
    response[static_cast<std::size_t>(distance - 1)] = std::sqrt(std::max(0.0, mean * mean - of_noise * of_noise));
  }
  const double largest = *std::max_element(response.begin(), response.end());
  if (!(largest > of_noise)) {
    throw Error(ErrorCode::kBadInput, "the image shows no texture above its noise of " +
                                          std::to_string(suggestion.noise_grey) +
                                          " grey levels: is it in focus, and lit so that the surface shows?");
  }
  // In terms of the modified Laplacian and a box, whose noise is known for every distance; the double box spreads as
  // far.
  FocusSettings settings{.focus_operator = FocusOperator::kModifiedLaplacian, .window = FocusWindow::kBox};
  const auto response_at = [&](int distance) { return response[static_cast<std::size_t>(distance - 1)]; };
  const auto noise_over_peak = [&](int distance, int window) {
    settings.window_px = window;
    return sample_noise(settings, suggestion.noise_grey, 0.0) / (window * window * response_at(distance));
  };
  const FocusSettings usual;
  suggestion.distance_px = usual.distance_px;
  suggestion.window_px = usual.window_px;
  if (!(noise_over_peak(usual.distance_px, usual.window_px) <= kMaxNoiseShare)) {
    while (response_at(suggestion.distance_px) < kMinResponseShare * largest) ++suggestion.distance_px;
  }
  while (suggestion.window_px < kMaxWindow_px &&
         !(noise_over_peak(suggestion.distance_px, suggestion.window_px) <= kMaxNoiseShare)) {
    suggestion.window_px += 2;
  }
  suggestion.response_grey = response_at(suggestion.distance_px);
  suggestion.sample_noise = noise_over_peak(suggestion.distance_px, suggestion.window_px);
  return suggestion;
}

}  // namespace fvd
