#pragma once

/// How an error of one slice's z moves the heights that are fitted through it.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// A height and the weight with which it counts in an estimate.
struct WeightedHeight {
  double height_um = 0.0;
  double weight = 0.0;
};

/// What an error of each sample's z does to heights, by where the heights lie. Derivatives are made when a height needs
/// them, and kept: those of one focus curve serve all values of an evaluation.
/// context: thread-safe.
class SliceSensitivity {
 public:
  /// sample_z_um: of the focus curve, strictly rising or falling, at least 3. curve_width_um: full width at half
  /// maximum, > 0.
  SliceSensitivity(std::span<const double> sample_z_um, double curve_width_um);

  /// Heights that lie within 1/32 of a step count as one: so many of these.
  [[nodiscard]] std::size_t bins() const { return derivatives_.size(); }
  /// bins() for a height outside the range, which counts for nothing.
  [[nodiscard]] std::size_t bin_of(double height_um) const {
    const double place = (height_um - lowest_um_) / bin_um_;
    if (!(place >= 0.0 && place < static_cast<double>(bins()))) return bins();
    return static_cast<std::size_t>(place);  // of the samples' mean step, which uneven ones make no worse
  }

  /// For an estimate sum(weight * height), its derivative with respect to the z of each sample, in um per um: the
  /// derivative of the five-sample fit of a Gaussian curve of this width (own definition), found by moving one z.
  /// weights: of each bin. Weights that sum to 1 give derivatives that sum to 1, and those of a step give 0.
  /// pool: may be null; the result is the same.
  [[nodiscard]] std::vector<double> of(std::span<const double> weights, WorkerPool* pool);

 private:
  static constexpr int kReach = 2;  ///< samples on each side of the peak that the fit takes
  struct Derivatives {
    bool known = false;
    std::size_t centre = 0;  ///< sample at the peak
    std::array<double, 2 * kReach + 1> at{};
  };
  [[nodiscard]] Derivatives derivatives_at(double height_um) const;
  /// The derivatives of all bins that have a weight.
  void make_known(std::span<const double> weights, WorkerPool* pool);

  std::vector<double> z_um_;
  double width_um_;
  double lowest_um_;
  double bin_um_ = 0.0;
  Mutex making_;
  std::vector<Derivatives> derivatives_;  // one that is known does not change any more; made with making_ held
};

/// The same for single heights and their weights. context: pure.
[[nodiscard]] std::vector<double> slice_sensitivities(std::span<const double> sample_z_um, double curve_width_um,
                                                      std::span<const WeightedHeight> heights);

}  // namespace fvd
