/// Speed of the streaming focus stack on slices of 2448 x 2048. Mpx/s: pixels of slices a second of wall clock, in
/// millions.
///   build/tests/bench/bench_focus [--benchmark_format=json]

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

#include "benchmark/benchmark.h"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/pipeline/worker_pool.hpp"

namespace fvd {
namespace {

constexpr int kWidth = 2448;
constexpr int kHeight = 2048;
constexpr int kDistinctSlices = 8;

template <typename Pixel>
constexpr PixelFormat kFormat = sizeof(Pixel) == 1 ? PixelFormat::kMono8 : PixelFormat::kMono16;

/// Noise whose contrast rises and falls again, so that peaks are found and left as in a scan. Nothing is saturated.
template <typename Pixel>
std::array<Plane<Pixel>, kDistinctSlices> make_slices() {
  std::array<Plane<Pixel>, kDistinctSlices> slices;
  std::mt19937 random(1);
  int slice_number = 0;
  for (auto& slice : slices) {
    slice = Plane<Pixel>(kWidth, kHeight);
    const int from_middle = std::abs(2 * slice_number++ - kDistinctSlices);
    const auto contrast = static_cast<unsigned long>(200 - 20 * from_middle);
    for (auto& pixel : slice.pixels()) {
      const auto level = 20 + random() % contrast;
      pixel = static_cast<Pixel>(sizeof(Pixel) == 1 ? level : level * 256);
    }
  }
  return slices;
}

/// Arguments: window in pixels, threads, slices pushed together.
template <typename Pixel>
void push(benchmark::State& state) {
  const auto slices = make_slices<Pixel>();
  WorkerPool pool(static_cast<int>(state.range(1)));
  FocusSettings settings;
  settings.window_px = static_cast<int>(state.range(0));
  StreamingFocusStack stack(kWidth, kHeight, kFormat<Pixel>, settings, pool);
  std::array<ZSlice, kDistinctSlices> batch;
  for (std::size_t k = 0; k < batch.size(); ++k) batch[k] = {image_view(slices[k].view(), kFormat<Pixel>), 0.0};
  const auto together = static_cast<std::size_t>(state.range(2));
  std::size_t next = 0;
  for (auto _ : state) {
    stack.push(std::span(batch).subspan(next, together));
    next = (next + together) % kDistinctSlices;
  }
  state.counters["Mpx/s"] = benchmark::Counter(1e-6 * kWidth * kHeight * static_cast<double>(together),
                                               benchmark::Counter::kIsIterationInvariantRate);
  state.counters["state_bytes_per_pixel"] = stack.state_bytes_per_pixel();
}

/// Arguments: peak method, threads.
void finish(benchmark::State& state) {
  const auto slices = make_slices<std::uint8_t>();
  WorkerPool pool(static_cast<int>(state.range(1)));
  StreamingFocusStack stack(kWidth, kHeight, PixelFormat::kMono8, {}, pool);
  for (int k = 0; k < kDistinctSlices; ++k) {
    stack.push(image_view(slices[static_cast<std::size_t>(k)].view(), PixelFormat::kMono8), k);
  }
  const auto method = static_cast<PeakMethod>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(stack.finish(method));
  state.SetLabel(std::string(peak_method_name(method)));
  state.counters["Mpx/s"] = benchmark::Counter(1e-6 * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate);
}

void windows_and_threads(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"window", "threads", "batch"})
      ->ArgsProduct({{9, 31}, {1, 2}, {1, 8}})
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

BENCHMARK(push<std::uint8_t>)->Name("push/Mono8")->Apply(windows_and_threads);
BENCHMARK(push<std::uint16_t>)->Name("push/Mono16")->Apply(windows_and_threads);
BENCHMARK(finish)
    ->Name("finish/Mono8")
    ->ArgNames({"method", "threads"})
    ->ArgsProduct({{static_cast<int>(PeakMethod::kParabola), static_cast<int>(PeakMethod::kFiveSample)}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fvd

BENCHMARK_MAIN();
