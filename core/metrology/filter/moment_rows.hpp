#pragma once

/// Sums of a plane, weighted by a separable kernel times powers of the distance, around every point of a row.

#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "core/image/image.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// Symmetric in x and y; weights at the distances 0, 1, ... pixels. Sum 1 or of that order.
struct SeparableKernel {
  std::vector<double> half_x;
  std::vector<double> half_y;
  double unit_x_px = 1.0;  ///< distances are counted in these
  double unit_y_px = 1.0;
};

struct MomentPower {
  int x = 0;
  int y = 0;
};

/// The sums, by Fourier transforms along y for the few waves along x that a smooth kernel passes, then along x for one
/// row after the other: sum(p) = sum over d of source(p - d) d_x^i d_y^j kernel(d); outside the plane the source is 0.
/// Errors: about 1e-15 of the kernel's sum times the source's height. Bands of rows keep memory bounded.
/// The same bytes for any number of threads. pool null: the caller alone.
class MomentRows {
 public:
  /// A band of a plane, transformed along x and summed along y, for each power of the distance in y.
  /// Waves stand in blocks, for the work goes along rows and along columns.
  struct Band {
    int first_row = 0;
    std::vector<std::vector<std::complex<double>>>
        waves;  ///< for each power [block of waves along x][row of the band][kWavesOfABlock]
  };

  /// highest_power >= 0: of x or y in any power asked for. kept: bands' powers kept in memory at a time.
  MomentRows(int width, int height, const SeparableKernel& kernel, int highest_power, int kept, WorkerPool* pool);
  ~MomentRows();
  MomentRows(const MomentRows&) = delete;
  MomentRows& operator=(const MomentRows&) = delete;

  [[nodiscard]] int bands() const;
  [[nodiscard]] int first_row(int band) const;  ///< first_row(bands()) = height
  [[nodiscard]] int lanes() const;              ///< threads, or 1
  /// source: the whole plane, no NaN; powers of y from 0 to highest_y. context: one thread.
  [[nodiscard]] Band load(const Plane<double>& source, int band, int highest_y);
  /// Writes the sums of one row of the field, which lies in the band. context: one thread a lane.
  void sum_row(const Band& band, int row, MomentPower power, int lane, double* sums);
  /// body(lane, row) for each row of the field in the band, on any thread.
  void each_row(int band, const std::function<void(int, int)>& body);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// body(lane) for every lane in [0, lanes): in the pool, or one after the other without one.
void run_lanes(WorkerPool* pool, int lanes, const std::function<void(int)>& body);

}  // namespace fvd::metrology
