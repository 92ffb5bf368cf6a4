#pragma once

/// From the condensed curves of a whole image to its height map: the steps that need more than one row. Both stacks use
/// them, so that they differ only in how a curve is condensed.

#include <functional>

#include "core/focus/fit/height_map.hpp"
#include "core/focus/fit/row_fit.hpp"
#include "core/focus/measure/noise_probe.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// Returns the condensed curves of row y, which may lie in memory of the calling thread and are valid until its next
/// call. Writes the row's grey levels to `texture`, shape [width], unless it is nullptr.
using CurveSource = std::function<CurveRow(int thread, int y, std::uint16_t* texture)>;

/// Fills all planes and figures of an empty_map(). z_um: measured z of each sample. context: computes on the caller's
/// thread and on the pool.
void finish_map(const CurveSource& curves, const std::vector<double>& z_um, const FocusSettings& settings,
                PeakMethod method, const NoiseProbe& noise, WorkerPool& pool, HeightMap& map);

}  // namespace fvd
