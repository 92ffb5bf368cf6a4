#pragma once

/// The points of a region as a block of heights for a fit.

#include <cstddef>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// The smallest block of pixels that holds all valid points of a region. Normal coordinates run from -1 to 1 between
/// the outer borders of the block; they are exactly mirrored when the surface is.
struct ChosenPoints {
  Plane<double> z_um;      ///< [rows][columns] of the block; NaN = hole or outside of the region
  Plane<float> sigma_um;   ///< empty where the field has none or it was not asked for
  std::vector<double> x;   ///< normal coordinate of each column
  std::vector<double> y;   ///< of each row
  std::size_t points = 0;  ///< valid ones
  double centre_x_um = 0.0;
  double centre_y_um = 0.0;
  double half_x_um = 1.0;  ///< x_um = centre_x_um + half_x_um * x
  double half_y_um = 1.0;
};

/// region: empty or of the shape of the field. context: pure.
[[nodiscard]] ChosenPoints choose_points(const HeightField& field, const Region& region, bool with_sigma,
                                         WorkerPool* pool = nullptr);

}  // namespace fvd::metrology
