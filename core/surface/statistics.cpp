#include "core/surface/statistics.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "core/base/units.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd {

namespace {

double um(float metres) { return static_cast<double>(metres) / kMetresPerMicrometer; }

constexpr std::size_t kDigits = std::size_t{1} << 16U;  ///< a value has two of them

/// A key that ascends as the value does.
std::uint32_t key_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits >> 31U) != 0 ? ~bits : bits | 0x80000000U;
}

float value_of(std::uint32_t key) { return std::bit_cast<float>((key >> 31U) != 0 ? key & 0x7fffffffU : ~key); }

/// The finite values of a plane in their order, without sorting them: how often each upper half of a key occurs, and
/// then each lower half among those that are asked for.
class OrderedValues {
 public:
  explicit OrderedValues(std::span<const float> values) : values_(values), upper_(kDigits) {
    for (std::size_t first = 0; first < values.size(); first += kBlock) {
      // Blocks are summed by themselves, so that the sum of millions keeps its digits.
      std::array<double, kLanes> sums{};
      const auto block = values.subspan(first, std::min(kBlock, values.size() - first));
      for (std::size_t i = 0; i < block.size(); ++i) {
        const float value = block[i];
        if (!std::isfinite(value)) continue;
        ++upper_[key_of(value) >> 16U];
        sums[i % kLanes] += static_cast<double>(value);
      }
      for (const double sum : sums) sum_ += sum;
    }
    for (const std::size_t count : upper_) count_ += count;
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double sum() const { return sum_; }

  /// The values of these ranks, 0 = the smallest; each below count().
  [[nodiscard]] std::vector<float> at_ranks(const std::vector<std::size_t>& ranks) const {
    struct Place {
      std::size_t upper;
      std::size_t rank;  // among the values with that upper half
    };
    std::vector<Place> places;
    std::vector<std::uint8_t> slot_of(kDigits, 0);
    std::vector<std::vector<std::size_t>> lower(1);
    for (std::size_t rank : ranks) {
      std::size_t upper = 0;
      while (rank >= upper_[upper]) rank -= upper_[upper++];
      places.push_back({upper, rank});
      if (slot_of[upper] != 0) continue;
      slot_of[upper] = static_cast<std::uint8_t>(lower.size());
      lower.emplace_back(kDigits);
    }
    for (const float value : values_) {
      const std::uint32_t key = key_of(value);  // a NaN's upper half is that of no finite value
      const std::uint8_t slot = slot_of[key >> 16U];
      if (slot != 0) ++lower[slot][key & 0xffffU];
    }
    std::vector<float> found;
    for (auto [upper, rank] : places) {
      const std::vector<std::size_t>& counts = lower[slot_of[upper]];
      std::size_t digit = 0;
      while (rank >= counts[digit]) rank -= counts[digit++];
      found.push_back(value_of(static_cast<std::uint32_t>(upper << 16U | digit)));
    }
    return found;
  }

 private:
  static constexpr std::size_t kBlock = 4096;
  static constexpr std::size_t kLanes = 4;

  std::span<const float> values_;
  std::vector<std::size_t> upper_;
  std::size_t count_ = 0;
  double sum_ = 0.0;
};

/// Of an even number the mean of the two in the middle.
std::vector<std::size_t> middle_ranks(std::size_t count) { return {(count - 1) / 2, count / 2}; }

double median_um(float lower, float upper) { return (um(lower) + um(upper)) / 2; }

/// Of the value below which the fraction of the others lies: nearest rank.
std::size_t rank_of(double fraction, std::size_t count) {
  return static_cast<std::size_t>(std::lround(fraction * static_cast<double>(count - 1)));
}

/// How often each reason other than none occurs.
std::vector<std::size_t> points_of_reasons(std::span<const MaskReasons> mask) {
  static_assert(sizeof(MaskReasons) == 2);
  constexpr std::size_t kAtOnce = sizeof(std::uint64_t) / sizeof(MaskReasons);
  std::vector<std::size_t> points_of(std::size_t{1} << std::numeric_limits<MaskReasons>::digits);
  std::size_t i = 0;
  for (; i + kAtOnce <= mask.size(); i += kAtOnce) {
    std::uint64_t four = 0;
    std::memcpy(&four, mask.data() + i, sizeof four);
    if (four == 0) continue;  // most points are valid
    for (std::size_t k = 0; k < kAtOnce; ++k) ++points_of[mask[i + k]];
  }
  for (; i < mask.size(); ++i) ++points_of[mask[i]];
  return points_of;
}

void count_reasons(MaskReasons reasons, std::size_t points, HoleCounts& holes) {
  if ((reasons & mask_reason::kLowProminence) != 0) holes.low_prominence += points;
  if ((reasons & mask_reason::kFirstSlice) != 0) holes.first_slice += points;
  if ((reasons & mask_reason::kLastSlice) != 0) holes.last_slice += points;
  if ((reasons & mask_reason::kNotBracketed) != 0) holes.not_bracketed += points;
  if ((reasons & mask_reason::kSaturated) != 0) holes.saturated += points;
  if ((reasons & mask_reason::kInsignificant) != 0) holes.insignificant += points;
  if ((reasons & mask_reason::kEdgeBleeding) != 0) holes.edge_bleeding += points;
  if ((reasons & mask_reason::kBroadCurve) != 0) holes.broad_curve += points;
  if ((reasons & mask_reason::kNarrowCurve) != 0) holes.narrow_curve += points;
  if ((reasons & mask_reason::kSecondPeak) != 0) holes.second_peak += points;
  if ((reasons & mask_reason::kEdgeBand) != 0) holes.edge_band += points;
  if ((reasons & mask_reason::kMaxSigma) != 0) holes.max_sigma += points;
  if ((reasons & mask_reason::kOutOfView) != 0) holes.out_of_view += points;
}

}  // namespace

HeightSummary summarize_heights(const Plane<float>& height_m, const Plane<float>& sigma_m,
                                const Plane<MaskReasons>& mask) {
  HeightSummary summary;
  summary.points = mask.pixels().size();
  const std::vector<std::size_t> points_of = points_of_reasons(mask.pixels());
  for (std::size_t reasons = 1; reasons < points_of.size(); ++reasons) {
    if (points_of[reasons] > 0) count_reasons(static_cast<MaskReasons>(reasons), points_of[reasons], summary.holes);
  }
  const OrderedValues heights(height_m.pixels());
  summary.valid = heights.count();
  if (summary.valid == 0) return summary;
  std::vector<std::size_t> ranks = middle_ranks(summary.valid);
  ranks.insert(ranks.end(), {0, summary.valid - 1, rank_of(0.005, summary.valid), rank_of(0.995, summary.valid)});
  const std::vector<float> found = heights.at_ranks(ranks);
  HeightValues values;
  values.median_um = median_um(found[0], found[1]);
  values.min_um = um(found[2]);
  values.max_um = um(found[3]);
  values.low_um = um(found[4]);
  values.high_um = um(found[5]);
  values.mean_um = heights.sum() / static_cast<double>(summary.valid) / kMetresPerMicrometer;
  summary.height = values;
  const OrderedValues errors(sigma_m.pixels());
  if (errors.count() == 0) return summary;
  const std::vector<float> middle = errors.at_ranks(middle_ranks(errors.count()));
  summary.sigma_median_um = median_um(middle[0], middle[1]);
  return summary;
}

}  // namespace fvd
