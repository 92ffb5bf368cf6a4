#pragma once

/// The material ratio curve of heights, areal or of a profile, and what is read from it.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fvd::metrology {

/// The heights in descending order. Equal values give equal bytes whatever their order was.
[[nodiscard]] std::vector<double> sorted_descending(std::vector<double> heights);

/// Sk Spk Svk Smr1 Smr2 of ISO 25178-2:2021, or Rk Rpk Rvk Rmrk1 Rmrk2 of ISO 21920-2:2021.
struct CoreParameters {
  double core_um = 0.0;         ///< Sk: height of the core
  double peak_um = 0.0;         ///< Spk: reduced peak height
  double valley_um = 0.0;       ///< Svk: reduced pit depth
  double ratio1_percent = 0.0;  ///< Smr1: where the peaks end
  double ratio2_percent = 0.0;  ///< Smr2: where the pits begin
  double core_top_um = 0.0;     ///< the equivalent straight line at 0 %
  double secant_percent = 0.0;  ///< where the smallest secant begins
  bool tie = false;             ///< another secant, apart from it, is as small; the first from the left was taken
};

/// Height over material ratio. Own definition for sampled surfaces: point i of n in descending order, i from 0, stands
/// at the ratio (i + 0.5) / n, so that figures of a smooth surface are right to O(1/n^2). Equal heights (to 1e-12 of
/// the range) stand at the middle of their ratios, or, where they are more than 5 % of all, form a level stretch. The
/// curve is straight between points, and level from the first to 0 % and from the last to 100 %. Results depend on the
/// multiset of heights only.
class MaterialRatioCurve {
 public:
  /// descending: at least one finite height, sorted_descending().
  explicit MaterialRatioCurve(std::span<const double> descending);

  /// c(p): the height at a ratio of 0 to 100 %. ISO 25178-2:2021 Smc(p), ISO 21920-2:2021 Rcm(p).
  [[nodiscard]] double height_at_um(double ratio_percent) const;
  /// p(c): the last ratio at which the curve is at the height or above; 0 above its top, 100 at its bottom and below.
  /// ISO 21920-2:2021 Rmr(c) on the curve; see material_ratio_percent() for the exact count.
  [[nodiscard]] double ratio_at_percent(double height_um) const;
  /// Vm(p): material above c(p), um3/um2. ISO 25178-2:2021.
  [[nodiscard]] double material_volume_um(double ratio_percent) const;
  /// Vv(p): void below c(p), um3/um2. ISO 25178-2:2021.
  [[nodiscard]] double void_volume_um(double ratio_percent) const;
  /// The equivalent straight line by the smallest secant over 40 % of the points, and the triangles of equal area above
  /// and below it. ISO 25178-2:2021, ISO 21920-2:2021 (before: ISO 13565-2:1996 clauses 4, 5). For the secant the curve
  /// goes on straight from its first and last point to 0 % and 100 %.
  [[nodiscard]] CoreParameters core() const;

 private:
  struct Knot {
    double ratio;  ///< 0 to 1, strictly increasing
    double height_um;
  };

  [[nodiscard]] static double ratio_between(const Knot& from, const Knot& to, double height_um);
  [[nodiscard]] double height_of(double ratio) const;
  [[nodiscard]] double first_ratio_of(double height_um) const;  // the curve is at the height or below from here on
  [[nodiscard]] double last_ratio_of(double height_um) const;   // the curve is at the height or above up to here
  [[nodiscard]] double area_above(double ratio, double height_um) const;
  [[nodiscard]] double area_below(double ratio, double height_um) const;

  std::vector<Knot> knots_;
};

/// Smr(c): the share of heights that are at c or above. Exact count. descending: as above. ISO 25178-2:2021.
[[nodiscard]] double material_ratio_percent(std::span<const double> descending, double height_um);

}  // namespace fvd::metrology
