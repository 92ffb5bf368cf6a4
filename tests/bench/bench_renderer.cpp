/// How fast the simulated microscope shows slices. Arguments: side of the sensor in pixels, threads.

#include <vector>

#include <benchmark/benchmark.h>

#include "sim/world/defocus_renderer.hpp"
#include "sim/world/texture.hpp"

namespace fvd::sim {
namespace {

void render_slices(benchmark::State& state) {
  const int width = static_cast<int>(state.range(0));
  const int height = width == 480 ? 360 : width;
  const Plane<std::uint8_t> rich(width, height);
  Plane<float> heights(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) heights.at(x, y) = 160.0F * static_cast<float>(x) / static_cast<float>(width);
  }
  DefocusRenderer renderer(make_texture(TextureKind::kGranite, rich, 28.0, 1.0, 1), heights,
                           {.threads = static_cast<int>(state.range(1))});
  ExposureRequest request;
  request.width = width;
  request.height = height;
  std::vector<std::byte> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  double z_um = 0.0;
  for (auto _ : state) {
    ++request.exposure_index;
    renderer.render(z_um, request, out);
    z_um = z_um > 160.0 ? 0.0 : z_um + 10.0;
  }
  state.counters["frames/s"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["MiB"] = static_cast<double>(renderer.memory_bytes() >> 20U);
}
BENCHMARK(render_slices)
    ->Name("render/Mono8")
    ->ArgNames({"width", "threads"})
    ->Args({480, 1})
    ->Args({480, 2})
    ->Args({2048, 1})
    ->Args({2048, 2})
    ->UseRealTime();

}  // namespace
}  // namespace fvd::sim

BENCHMARK_MAIN();
