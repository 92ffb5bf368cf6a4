#pragma once

/// Sums of a plane, weighted by a separable kernel times powers of the distance, around every point.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/image/image.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// Symmetric in x and y; weights at the distances 0, 1, ... pixels.
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

/// The sums, band by band of rows so that memory stays bounded, by Fourier transforms: out(p) = sum over d of
/// source(p - d) d_x^i d_y^j kernel(d); outside the plane the source is 0. Errors: 1e-16 of the kernel's sum times the
/// source's height. The same bytes for any number of threads. context: one thread an object; pool null: the caller
/// alone.
class BandMoments {
 public:
  /// highest_power >= 0: of x or y in any power asked for.
  BandMoments(int width, int height, const SeparableKernel& kernel, int highest_power, WorkerPool* pool);
  ~BandMoments();
  BandMoments(const BandMoments&) = delete;
  BandMoments& operator=(const BandMoments&) = delete;

  [[nodiscard]] int bands() const;
  [[nodiscard]] int first_row(int band) const;  ///< first_row(bands()) = height
  /// source: the whole plane, no NaN. sums: one for each power, replaced by planes of width x rows of the band.
  void compute(const Plane<double>& source, int band, std::span<const MomentPower> powers,
               std::span<Plane<double>> sums);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Sum of the source weighted by the kernel around every point; outside the plane the source is 0. Short kernels are
/// added up, long ones go through BandMoments. context: pure.
[[nodiscard]] Plane<double> separable_sum(const Plane<double>& source, const SeparableKernel& kernel, WorkerPool* pool);

/// body(lane) for every lane in [0, lanes): in the pool, or one after the other without one.
void run_lanes(WorkerPool* pool, int lanes, const std::function<void(int)>& body);

}  // namespace fvd::metrology
