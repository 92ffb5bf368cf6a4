#pragma once

/// Heights beside a missing slice, as the scan's own curves tell them.
///
/// A peak in the sample next to the gap has no neighbour on that side. Curves differ in width from place to place, and
/// without that neighbour the five-sample fit takes a wider curve for one whose vertex lies further out. What tells the
/// two apart, the samples two steps away, has next to no weight in it. The scan has thousands of curves without a gap:
/// of each, the sample that would be missing is disregarded, and the vertex that all five tell is expressed by the
/// three others' shares, as a cubic polynomial by least squares. Noise is in these shares as it is in those beside the
/// gap, so the polynomial trusts them as far as they can be trusted. It knows nothing of curves that are unlike those
/// it learnt from, those of another texture beside the gap: they keep the five-sample fit.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/focus/fit/curve_shape.hpp"
#include "core/focus/fit/curve_tuple.hpp"
#include "core/focus/fit/row_fit.hpp"

namespace fvd {

/// context: const members from many threads.
class GapFit {
 public:
  /// tuples: spread over the image, their indices within z_um; those with lower neighbours than `limits` asks for tell
  /// nothing. z_um: of each sample. Without gaps, without a width in `shape` or with fewer than 500 such curves, or
  /// with vertices that do not lie all over a step, nothing is corrected.
  GapFit(std::span<const CurveTuple> tuples, const std::vector<double>& z_um, const CurveShape& shape,
         const CurveLimits& limits);

  /// Of the five-sample fit's heights of one row; NaN stays. Shape [width].
  void correct(const RowFit& fit, const CurveRow& row, int width, float* height_m) const noexcept;
  /// The same of one curve, whose height_um is that of the five-sample fit; in um.
  [[nodiscard]] double height_um(const CurveTuple& curve) const noexcept;

 private:
  static constexpr int kTerms = 20;  // of a cubic of three variables
  using Terms = std::array<double, kTerms>;
  using Three = std::array<double, 3>;
  /// The vertex in steps from the peak's sample towards the gap.
  struct Polynomial {
    Three mean{};  // of the shares
    Three sd{};
    Terms factors{};
    /// Columns of a matrix that makes of the terms others, whose squares' sum is 1 in the mean over the curves that
    /// were learnt from.
    std::array<Terms, kTerms> whitening{};
  };

  [[nodiscard]] static Terms terms(const Three& x) noexcept;
  /// 1 in the mean over the curves that were learnt from, and the more the further a curve is from all of them.
  [[nodiscard]] static double strangeness(const Terms& terms, const Polynomial& polynomial) noexcept;
  /// The samples two steps and one step away from the gap, and the one beyond it, as if they were exactly in their
  /// places for a curve with its vertex at height_um. towards: +1 for a gap after the peak's sample, -1 before.
  /// beyond: number of the sample beyond it, from the peak's.
  [[nodiscard]] Three shares_in_place(const CurveTuple& curve, int towards, int beyond,
                                      double height_um) const noexcept;
  [[nodiscard]] bool in_place(int index, int towards, int beyond) const noexcept;
  [[nodiscard]] std::optional<Polynomial> learn(std::span<const CurveTuple> tuples, const CurveShape& shape,
                                                const CurveLimits& limits, int towards) const;

  std::vector<double> z_um_;
  double step_um_ = 0.0;  // signed
  ScanCurve model_;
  std::vector<std::int8_t> towards_gap_;                  // by sample; 0 = no gap beside it
  std::array<std::optional<Polynomial>, 2> polynomials_;  // of a gap before and after the peak's sample
  bool any_ = false;
};

}  // namespace fvd
