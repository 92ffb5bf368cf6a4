#pragma once

/// Scans of sinusoidal surfaces: what of their amplitude a height map shows.

#include <optional>

#include "core/focus/measure/focus_settings.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::bench {

/// Amplitude in the map of a white texture on a sine of that period along the rows, over the true amplitude.
[[nodiscard]] double sine_transfer(const FocusSettings& settings, std::optional<double> smooth_px, double period_px,
                                   WorkerPool& pool);

/// The period at which sine_transfer() is one half, px.
[[nodiscard]] double measured_lateral_period_px(const FocusSettings& settings, std::optional<double> smooth_px,
                                                WorkerPool& pool);

}  // namespace fvd::bench
