#include "core/metrology/areal/height_moments.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace fvd::metrology {
namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kBlock = 1024;

/// A sum of terms that are at most `largest` in size. Each is taken apart into a whole number of parts, 2^-50 of the
/// largest, and a whole number of parts of these, 2^-100; whole numbers have the same sum in any order.
class WholeSum {
 public:
  explicit WholeSum(double largest) {
    if (!(largest > 0.0)) return;
    const int exponent = std::clamp(50 - std::ilogb(largest), -1000, 1000);
    parts_ = std::ldexp(1.0, exponent);
  }

  /// Below kBlock terms at a time, then carry().
  void add(std::size_t lane, double term) {
    // The sum's lowest bits are the whole number; it does not leave the range of one exponent.
    const double in_parts = term * parts_;
    const double whole = in_parts + kWhole;
    const double rest = in_parts - (whole - kWhole);
    coarse_[lane] += std::bit_cast<std::int64_t>(whole) - kWholeBits;
    fine_[lane] += std::bit_cast<std::int64_t>(rest * kFine + kWhole) - kWholeBits;
  }
  void carry() {
    for (std::int64_t& lane : coarse_) {
      high_ += lane >> kLowBits;
      low_ += lane & kLowMask;
      lane = 0;
    }
    for (std::int64_t& lane : fine_) {
      fine_high_ += lane >> kLowBits;
      fine_low_ += lane & kLowMask;
      lane = 0;
    }
  }
  [[nodiscard]] double sum() const { return (joined(high_, low_) + joined(fine_high_, fine_low_) / kFine) / parts_; }

 private:
  static constexpr double kWhole = 0x1.8p52;
  static constexpr std::int64_t kWholeBits = std::bit_cast<std::int64_t>(kWhole);
  static constexpr int kLowBits = 32;
  static constexpr std::int64_t kLowMask = (std::int64_t{1} << kLowBits) - 1;

  static constexpr double kFine = 0x1p50;

  static double joined(std::int64_t high, std::int64_t low) {
    return std::ldexp(static_cast<double>(high), kLowBits) + static_cast<double>(low);
  }

  double parts_ = 1.0;  // in a unit of the terms
  std::array<std::int64_t, kLanes> coarse_{};
  std::array<std::int64_t, kLanes> fine_{};
  std::int64_t high_ = 0;
  std::int64_t low_ = 0;
  std::int64_t fine_high_ = 0;
  std::int64_t fine_low_ = 0;
};

/// visit(lane, height) for each; carry() after each block.
template <typename Visit, typename Carry>
void each_height(std::span<const double> heights, const Visit& visit, const Carry& carry) {
  for (std::size_t first = 0; first < heights.size(); first += kBlock) {
    const auto block = heights.subspan(first, std::min(kBlock, heights.size() - first));
    std::size_t i = 0;
    for (; i + kLanes <= block.size(); i += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) visit(lane, block[i + lane]);
    }
    for (; i < block.size(); ++i) visit(0, block[i]);
    carry();
  }
}

struct Extremes {
  double lowest = 0.0;
  double highest = 0.0;
};

Extremes extremes_of(std::span<const double> heights) {
  std::array<double, kLanes> lowest{};
  std::array<double, kLanes> highest{};
  lowest.fill(heights.front());
  highest.fill(heights.front());
  each_height(
      heights,
      [&](std::size_t lane, double z) {
        lowest[lane] = z < lowest[lane] ? z : lowest[lane];
        highest[lane] = z > highest[lane] ? z : highest[lane];
      },
      [] {});
  // + 0.0: of 0 and -0 either may have been found.
  return {*std::min_element(lowest.begin(), lowest.end()) + 0.0,
          *std::max_element(highest.begin(), highest.end()) + 0.0};
}

}  // namespace

double mean_height_um(std::span<const double> heights_um) {
  assert(!heights_um.empty());
  // About their middle, so that a surface far from z = 0 loses no digits.
  const Extremes extremes = extremes_of(heights_um);
  const double middle = 0.5 * extremes.lowest + 0.5 * extremes.highest;
  WholeSum sum(extremes.highest - extremes.lowest);
  each_height(
      heights_um, [&](std::size_t lane, double z) { sum.add(lane, z - middle); }, [&] { sum.carry(); });
  return middle + sum.sum() / static_cast<double>(heights_um.size());
}

HeightMoments height_moments(std::span<const double> heights_um) {
  assert(!heights_um.empty());
  const auto count = static_cast<double>(heights_um.size());
  const Extremes extremes = extremes_of(heights_um);
  HeightMoments moments;
  moments.peak_um = extremes.highest;
  moments.pit_um = -extremes.lowest;
  const double largest = std::max(std::abs(extremes.highest), std::abs(extremes.lowest));
  if (largest == 0.0) return moments;
  // In a unit, a power of 2, of which there are 1 to 2 in the largest.
  const double unit_um = std::ldexp(1.0, std::clamp(std::ilogb(largest), -1000, 1000));
  const double per_um = 1.0 / unit_um;
  WholeSum first(2.0);
  WholeSum second(4.0);
  WholeSum third(8.0);
  WholeSum fourth(16.0);
  each_height(
      heights_um,
      [&](std::size_t lane, double z) {
        const double h = z * per_um;
        const double squared = h * h;
        first.add(lane, std::abs(h));
        second.add(lane, squared);
        third.add(lane, squared * h);
        fourth.add(lane, squared * squared);
      },
      [&] {
        first.carry();
        second.carry();
        third.carry();
        fourth.carry();
      });
  const double square = second.sum() / count;
  const double root = std::sqrt(square);
  moments.mean_absolute_um = unit_um * (first.sum() / count);
  moments.root_mean_square_um = unit_um * root;
  moments.skewness = third.sum() / count / (square * root);
  moments.kurtosis = fourth.sum() / count / (square * square);
  return moments;
}

}  // namespace fvd::metrology
