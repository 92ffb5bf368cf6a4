#pragma once

/// Work on a plane in bands of rows.

#include <algorithm>
#include <functional>

#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// Bands have the same rows whatever the number of threads, so that sums made per band and added in order do too.
inline constexpr int kBandRows = 32;

[[nodiscard]] inline int band_count(int rows) { return (rows + kBandRows - 1) / kBandRows; }

/// Calls body(band, first_row, end_row) once for every band; in the caller's thread where pool is null.
template <typename Body>
void run_bands(WorkerPool* pool, int rows, const Body& body) {
  const auto one = [rows, &body](int band) {
    const int first = band * kBandRows;
    body(band, first, std::min(first + kBandRows, rows));
  };
  if (pool != nullptr) {
    pool->run(band_count(rows), std::ref(one));
  } else {
    for (int band = 0; band < band_count(rows); ++band) one(band);
  }
}

}  // namespace fvd::metrology
