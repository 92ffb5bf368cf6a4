/// How fast slices go through the streaming stack.

#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/pipeline/worker_pool.hpp"

namespace fvd {
namespace {

constexpr int kWidth = 2448;
constexpr int kHeight = 2048;

/// Arguments: window, threads.
template <typename Pixel>
void push_slices(benchmark::State& state) {
  const PixelFormat format = sizeof(Pixel) == 1 ? PixelFormat::kMono8 : PixelFormat::kMono16;
  std::mt19937 random(1);
  std::vector<Plane<Pixel>> slices;
  for (int i = 0; i < 4; ++i) {
    slices.emplace_back(kWidth, kHeight);
    for (Pixel& pixel : slices.back().pixels()) pixel = static_cast<Pixel>(random());
  }
  WorkerPool pool(static_cast<int>(state.range(1)));
  StreamingFocusStack stack(kWidth, kHeight, format, {.window_px = static_cast<int>(state.range(0))}, pool);
  double z_um = 0.0;
  for (auto _ : state) {
    stack.push(image_view(slices[static_cast<std::size_t>(stack.slices()) % slices.size()].view(), format), z_um);
    z_um += 10.0;
  }
  state.counters["Mpx/s"] = benchmark::Counter(1e-6 * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["state_bytes_per_pixel"] = stack.state_bytes_per_pixel();
}

BENCHMARK(push_slices<std::uint8_t>)
    ->Name("push/Mono8")
    ->ArgNames({"window", "threads"})
    ->Args({9, 1})
    ->Args({9, 2})
    ->Args({31, 1})
    ->Args({31, 2})
    ->UseRealTime();
BENCHMARK(push_slices<std::uint16_t>)
    ->Name("push/Mono16")
    ->ArgNames({"window", "threads"})
    ->Args({9, 1})
    ->Args({9, 2})
    ->UseRealTime();

void finish_scan(benchmark::State& state) {
  std::mt19937 random(1);
  WorkerPool pool(2);
  StreamingFocusStack stack(kWidth, kHeight, PixelFormat::kMono8, {}, pool);
  Plane<std::uint8_t> slice(kWidth, kHeight);
  for (int k = 0; k < 5; ++k) {
    for (auto& pixel : slice.pixels()) pixel = static_cast<std::uint8_t>(random());
    stack.push(image_view(slice.view(), PixelFormat::kMono8), 10.0 * k);
  }
  for (auto _ : state) benchmark::DoNotOptimize(stack.finish(PeakMethod::kLogParabola));
}
BENCHMARK(finish_scan)->Name("finish/Mono8")->UseRealTime();

}  // namespace
}  // namespace fvd

BENCHMARK_MAIN();
