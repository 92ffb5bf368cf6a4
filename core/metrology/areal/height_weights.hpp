#pragma once

/// How parameters of heights change with each height: what their noise follows from.

#include <optional>

#include "core/metrology/areal/areal_parameters.hpp"
#include "core/metrology/areal/height_statistics.hpp"
#include "core/metrology/height_field.hpp"
#include "core/metrology/uncertainty/weight_map.hpp"

namespace fvd::metrology {

/// Of one region's parameters. The field and the region outlive it. context: pure.
class HeightWeights {
 public:
  /// statistics: of the same field and region.
  HeightWeights(const HeightField& field, const Region& region, const HeightStatistics& statistics)
      : field_(field), region_(region), statistics_(statistics) {}

  /// Derivatives of Sa, Sq, Ssk, Sku, Sp, Sv or Sz to the heights of the region's valid points, with the mean that
  /// moves with them (first order, GUM 5.1.3): e.g. z / (N Sq) for Sq. Absent for other parameters, and where the
  /// region has no points or, but for Sa and extremes, no scatter. Sp, Sv and Sz rest on single points; noise also lets
  /// other points take their place, which raises the value and is not told by a derivative.
  [[nodiscard]] std::optional<WeightMap> of(ArealParameter parameter) const;

 private:
  template <typename Derivative>
  [[nodiscard]] WeightMap mapped(const Derivative& derivative) const;
  void add_at_extreme(bool highest, double weight, WeightMap& map) const;

  const HeightField& field_;
  const Region& region_;
  HeightStatistics statistics_;
};

/// The same for one parameter.
[[nodiscard]] std::optional<WeightMap> height_weights(const HeightField& field, const Region& region,
                                                      ArealParameter parameter);

}  // namespace fvd::metrology
