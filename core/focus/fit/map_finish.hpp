#pragma once

/// From the condensed curves of a whole image to its height map: the steps that look beyond a single row. Shared by
/// both stacks, so that they differ in how a curve is condensed and in nothing else.

#include <functional>

#include "core/focus/fit/height_map.hpp"
#include "core/focus/fit/row_fit.hpp"
#include "core/focus/measure/noise_probe.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// The condensed curves of row y. It may show them in memory of the calling thread, good until the next call; `texture`
/// is where the row's grey levels go, or nullptr.
using CurveSource = std::function<CurveRow(int thread, int y, std::uint16_t* texture)>;

/// Fills all planes and figures of an empty_map. z_um: of the samples.
void finish_map(const CurveSource& curves, const std::vector<double>& z_um, const FocusSettings& settings,
                PeakMethod method, const NoiseProbe& noise, WorkerPool& pool, HeightMap& map);

}  // namespace fvd
