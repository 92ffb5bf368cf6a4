/// Speed of the focus core on slices of 2448 x 2048, and of the same job done the usual way.
///   build/tests/bench/bench_focus [--benchmark_format=json]
/// Mpx/s: pixels of slices per second of wall clock, in millions. Ratios: tests/bench/run_speed.sh.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "benchmark/benchmark.h"
#include "core/focus/measure/sharpness_rows.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {
namespace {

/// As in the daemon, one scan's memory is the next one's.
KeptPagesPtr kept_pages() {
  static const KeptPagesPtr pages = std::make_shared<KeptPages>(std::size_t{1} << 30);
  return pages;
}

constexpr int kWidth = 2448;
constexpr int kHeight = 2048;
constexpr int kSlices = 24;
constexpr double kMegapixels = 1e-6 * kWidth * kHeight;

/// A scan of a tilted surface: grain whose contrast rises and falls at its own slice in every column, and noise.
template <typename Pixel>
std::vector<Plane<Pixel>> make_scan(int bits) {
  std::mt19937 random(1);
  std::vector<float> grain(static_cast<std::size_t>(kWidth) * kHeight);
  for (float& value : grain) value = static_cast<float>(random() % 201) - 100.0F;
  std::vector<Plane<Pixel>> slices;
  const float unit = std::ldexp(1.0F, bits - 8);
  for (int k = 0; k < kSlices; ++k) {
    auto& slice = slices.emplace_back(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float u = (static_cast<float>(k) - 3.0F - 18.0F * static_cast<float>(x) / kWidth) / 2.0F;
        const float contrast = 1.0F / ((1.0F + 0.4F * u * u) * (1.0F + 0.4F * u * u));
        const float noise = static_cast<float>(random() & 3U);
        const std::size_t i = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
        slice.at(x, y) = static_cast<Pixel>((126.0F + contrast * grain[i] + noise) * unit);
      }
    }
  }
  return slices;
}

template <typename Pixel>
const std::vector<Plane<Pixel>>& scan(int bits) {
  static std::map<int, std::vector<Plane<Pixel>>> scans;
  auto& slices = scans[bits];
  if (slices.empty()) slices = make_scan<Pixel>(bits);
  return slices;
}

PixelFormat format_of(int bits) {
  return bits == 8 ? PixelFormat::kMono8 : bits == 12 ? PixelFormat::kMono12 : PixelFormat::kMono16;
}

/// Arguments: bits per pixel, window in pixels, threads, slices pushed together, slices per bin, 1 for the chapter's
/// modified Laplacian over a box and 0 for the defaults. One iteration is one
/// scan; the stack is made beforehand, as in a daemon. second_peak: see PointTests.
template <typename Pixel>
void streaming_with(benchmark::State& state, double second_peak) {
  const int bits = static_cast<int>(state.range(0));
  const auto& slices = scan<Pixel>(bits);
  WorkerPool pool(static_cast<int>(state.range(2)));
  FocusSettings settings;
  settings.window_px = static_cast<int>(state.range(1));
  settings.bin_slices = static_cast<int>(state.range(4));
  settings.tests.second_peak = second_peak;
  if (state.range(5) != 0) {
    settings.focus_operator = FocusOperator::kModifiedLaplacian;
    settings.window = FocusWindow::kBox;
  }
  std::array<ZSlice, kSlices> views;
  for (std::size_t k = 0; k < views.size(); ++k) {
    views[k] = {image_view(slices[k].view(), format_of(bits)), static_cast<double>(k)};
  }
  const auto together = static_cast<std::size_t>(state.range(3));
  double bytes = 0.0;
  for (auto _ : state) {
    StreamingFocusStack stack(kWidth, kHeight, format_of(bits), settings, pool, false, kept_pages());
    bytes = stack.state_bytes_per_pixel();
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t k = 0; k < kSlices; k += together) stack.push(std::span(views).subspan(k, together));
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  state.counters["Mpx/s"] = benchmark::Counter(kMegapixels * kSlices, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["state_bytes_per_pixel"] = bytes;
}

template <typename Pixel>
void streaming(benchmark::State& state) {
  streaming_with<Pixel>(state, 0.0);
}

void streaming_second_peak(benchmark::State& state) { streaming_with<std::uint8_t>(state, 0.8); }

/// Arguments: peak method, threads. Into memory that has been used before, as after the first scan.
void finish(benchmark::State& state) {
  const auto& slices = scan<std::uint8_t>(8);
  WorkerPool pool(static_cast<int>(state.range(1)));
  StreamingFocusStack stack(kWidth, kHeight, PixelFormat::kMono8, {}, pool, false, kept_pages());
  for (int k = 0; k < kSlices; ++k) {
    stack.push(image_view(slices[static_cast<std::size_t>(k)].view(), PixelFormat::kMono8), k);
  }
  const auto method = static_cast<PeakMethod>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(stack.finish(method));
  state.SetLabel(std::string(peak_method_name(method)));
  state.counters["Mpx/s"] = benchmark::Counter(kMegapixels, benchmark::Counter::kIsIterationInvariantRate);
}

/// The obviously correct sharpness, one window after the other, one thread.
void scalar_reference(benchmark::State& state) {
  const auto& slices = scan<std::uint8_t>(8);
  for (auto _ : state) {
    benchmark::DoNotOptimize(sharpness_reference(image_view(slices[12].view(), PixelFormat::kMono8), {}));
  }
  state.counters["Mpx/s"] = benchmark::Counter(kMegapixels, benchmark::Counter::kIsIterationInvariantRate);
}

/// The usual way: a stack of float sharpness planes, then the slice of the largest. Argument: threads.
void opencv_stored_stack(benchmark::State& state) {
  const auto& slices = scan<std::uint8_t>(8);
  cv::setNumThreads(static_cast<int>(state.range(0)));
  const cv::Mat across = (cv::Mat_<float>(1, 5) << -1, 0, 2, 0, -1);
  const cv::Mat down = across.t();
  std::vector<cv::Mat> stack(kSlices);
  for (cv::Mat& plane : stack) plane.create(kHeight, kWidth, CV_32F);
  cv::Mat horizontal;
  cv::Mat vertical;
  cv::Mat sum;
  cv::Mat best(kHeight, kWidth, CV_32F);
  cv::Mat index(kHeight, kWidth, CV_8U);
  cv::Mat higher;
  for (auto _ : state) {
    for (int k = 0; k < kSlices; ++k) {
      const auto& pixels = slices[static_cast<std::size_t>(k)];
      const cv::Mat image(kHeight, kWidth, CV_8U, const_cast<std::uint8_t*>(pixels.row(0)));
      cv::filter2D(image, horizontal, CV_32F, across, {-1, -1}, 0, cv::BORDER_REPLICATE);
      cv::filter2D(image, vertical, CV_32F, down, {-1, -1}, 0, cv::BORDER_REPLICATE);
      cv::add(cv::abs(horizontal), cv::abs(vertical), sum);
      cv::boxFilter(sum, stack[static_cast<std::size_t>(k)], CV_32F, {9, 9}, {-1, -1}, false);
    }
    stack[0].copyTo(best);
    index.setTo(0);
    for (int k = 1; k < kSlices; ++k) {
      cv::compare(stack[static_cast<std::size_t>(k)], best, higher, cv::CMP_GT);
      cv::max(stack[static_cast<std::size_t>(k)], best, best);
      index.setTo(k, higher);
    }
    benchmark::DoNotOptimize(index.data);
  }
  state.counters["Mpx/s"] = benchmark::Counter(kMegapixels * kSlices, benchmark::Counter::kIsIterationInvariantRate);
}

/// What memory can do: a copy of a slice; read and write counted. Argument: bytes a pixel.
void copy(benchmark::State& state) {
  const auto bytes = static_cast<std::size_t>(kWidth) * kHeight * static_cast<std::size_t>(state.range(0));
  std::vector<std::vector<std::byte>> from(8, std::vector<std::byte>(bytes, std::byte{1}));
  std::vector<std::vector<std::byte>> to(8, std::vector<std::byte>(bytes, std::byte{2}));
  std::size_t next = 0;
  for (auto _ : state) {
    std::memcpy(to[next].data(), from[next].data(), bytes);
    benchmark::ClobberMemory();
    next = (next + 1) % from.size();
  }
  state.counters["MB/s"] =
      benchmark::Counter(2e-6 * static_cast<double>(bytes), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(streaming<std::uint8_t>)
    ->Name("streaming/Mono8")
    ->ArgNames({"bits", "window", "threads", "batch", "bin", "sml"})
    ->Args({8, 9, 1, 8, 1, 0})
    ->Args({8, 9, 2, 8, 1, 0})
    ->Args({8, 31, 2, 8, 1, 0})
    ->Args({8, 9, 2, 1, 1, 0})
    ->Args({8, 9, 2, 8, 4, 0})
    ->Args({8, 9, 2, 8, 1, 1})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(streaming_second_peak)
    ->Name("streaming/Mono8_second_peak")
    ->ArgNames({"bits", "window", "threads", "batch", "bin", "sml"})
    ->Args({8, 9, 2, 8, 1, 0})
    ->Args({8, 9, 2, 8, 4, 0})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(streaming<std::uint16_t>)
    ->Name("streaming/Mono16")
    ->ArgNames({"bits", "window", "threads", "batch", "bin", "sml"})
    ->Args({12, 9, 1, 8, 1, 0})
    ->Args({12, 9, 2, 8, 1, 0})
    ->Args({16, 9, 1, 8, 1, 0})
    ->Args({16, 9, 2, 8, 1, 0})
    ->Args({16, 9, 2, 8, 4, 0})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(finish)
    ->Name("finish/Mono8")
    ->ArgNames({"method", "threads"})
    ->ArgsProduct({{static_cast<int>(PeakMethod::kLogParabola), static_cast<int>(PeakMethod::kFiveSample)}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(scalar_reference)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(opencv_stored_stack)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(copy)->ArgName("bytes")->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fvd

BENCHMARK_MAIN();
