#pragma once

/// Tables over operators, windows and smoothing.

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/runtime/worker_pool.hpp"

namespace fvd::bench {

/// What operator and window make of the same slices; data: folder of the generated stacks, left out where missing.
void operator_table(const std::filesystem::path& data, WorkerPool& pool);

/// A small window and a quadratic through the heights about each point.
void smooth_table(const std::filesystem::path& data, WorkerPool& pool);

/// Lateral periods measured, against the formula of lateral_period.hpp.
void lateral_table(WorkerPool& pool, nlohmann::ordered_json& json);

}  // namespace fvd::bench
