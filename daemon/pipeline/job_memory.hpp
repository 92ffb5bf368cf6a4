#pragma once

/// How much memory a job takes, from its recipe alone: known, and held against the budget, before anything moves.

#include <cstddef>

#include "core/base/large_array.hpp"
#include "daemon/recipes/recipe.hpp"

namespace fvd {

/// Bytes, by who holds them.
struct JobMemory {
  std::size_t state_bytes = 0;       ///< of the focus stack: what is kept of the slices
  std::size_t maps_bytes = 0;        ///< heights, errors, reasons, texture: one set per peak method
  std::size_t frames_bytes = 0;      ///< the camera's pool
  std::size_t encoding_bytes = 0;    ///< result files while they are made, before they are written
  std::size_t evaluation_bytes = 0;  ///< surfaces and what measurements make of them

  [[nodiscard]] std::size_t total_bytes() const noexcept {
    return state_bytes + maps_bytes + frames_bytes + encoding_bytes + evaluation_bytes;
  }
};

/// width, height: of the slices, > 0. threads >= 1: of the worker pool.
[[nodiscard]] JobMemory job_memory(const Recipe& recipe, int width, int height, int threads);

/// Throws Error kMemoryBudget, with the figures, if the job needs more than the budget. pages, null or what earlier
/// jobs left for reuse, are given back to the system where the budget would not hold both.
void require_memory(const JobMemory& needed, int width, int height, std::size_t budget_bytes, KeptPages* pages);

/// Throws Error kMemoryBudget, with the figure, if the evaluation of a stored surface of this size, and its report,
/// need more than the budget.
void require_evaluation_memory(const Recipe& recipe, int width, int height, std::size_t budget_bytes);

}  // namespace fvd
