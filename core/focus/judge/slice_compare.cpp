#include "core/focus/judge/slice_compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace fvd {

namespace {

/// Tiles darker than this share of the brightest, or than so many grey levels, say nothing of the light; nor do tiles
/// that are brighter than this share of full scale. A 12-bit camera's image may fill a hundredth of 16 bits.
constexpr double kLeastLit = 0.05;
constexpr double kLeastLit_grey = 2.0;
constexpr double kMostLit = 0.92;
/// Ratios of tiles within this share of their median are averaged.
constexpr double kNearMedian = 0.1;

/// A band of rows without signal is darker than this, over the reference's.
constexpr double kBandDark = 0.35;
constexpr double kOtherLevel = 0.05;

constexpr double kMinCorrelation = 0.2;
constexpr double kMinNegative = 0.75;
constexpr double kMinNegativeWeak = 0.8;
constexpr double kMinOrderSignificance = 8.0;
/// A slice two steps away differs more than one that is one step away, or as much where the focus lies between.
constexpr double kNotFarther = 1.1;

/// A tile shows texture if both neighbours' second differences are this often those of noise.
constexpr double kTexture = 2.5;
/// Of the second difference of rounded grey levels: 6 times 1/12.
constexpr double kRoundingEnergy = 0.5;
constexpr int kMinTiles = 6;
constexpr double kMinDirection = 0.35;
constexpr double kMinMotionSignificance = 8.0;
/// Measured 0.38 to 0.84 on slices that were smeared, -0.39 and below on clean ones that are less sharp than their
/// neighbours. What is sharper than both has a high one, too.
constexpr double kMinAgreement = 0.3;
constexpr double kLeastLoss = -0.15;  // a slice that was smeared is less sharp than its neighbours in any case
constexpr double kMaxLoss = -0.7;     // logarithm: half the squared second difference
/// Two exposures a few pixels apart may lose less than that: -0.46 and -0.63, with an agreement of 0.78 and 0.84. Clean
/// slices that agree by more than 0.4 lose nothing. Where jitter of some pixels adds its part, a slice in which hardly
/// any tile shows texture had -0.47 and 0.77.
constexpr double kFirmAgreement = 0.6;
constexpr double kFirmLoss = -0.35;
constexpr double kFirmShare = 0.3;

/// Mean squares of the step over those of the steps beside it, and of all three. On clean stacks no slice has a tenth
/// of such tiles, at steps of 0.1 to 1 widths; a slice that was taken twice has 1.0 of them and a change of 0.00.
constexpr double kStillerThanBeside = 2.0;
constexpr double kStillerThanAll = 4.0;
constexpr double kLeastStill = 0.3;
constexpr double kMostChange = 0.05;

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The band's samples all have one grey level.
bool band_one_level(const SliceFigures& slice, int row) noexcept {
  const std::uint16_t* first = slice.tile_samples(row * slice.columns);
  const std::uint16_t* end = first + static_cast<std::ptrdiff_t>(slice.columns) * slice.samples_per_tile;
  return std::all_of(first, end, [first](std::uint16_t level) { return level == *first; });
}

bool band_same(const SliceFigures& a, const SliceFigures& b, int row) noexcept {
  const std::uint16_t* first = a.tile_samples(row * a.columns);
  return std::equal(first, first + static_cast<std::ptrdiff_t>(a.columns) * a.samples_per_tile,
                    b.tile_samples(row * a.columns));
}

double least_lit(const std::vector<double>& means, double full_scale) {
  double most = 0.0;
  for (const double mean : means) {
    if (mean <= kMostLit * full_scale) most = std::max(most, mean);
  }
  return std::max(kLeastLit_grey, kLeastLit * most);
}

double band_mean(const SliceFigures& slice, int row) noexcept {
  double sum = 0.0;
  for (int column = 0; column < slice.columns; ++column) {
    sum += slice.means[static_cast<std::size_t>(row * slice.columns + column)];
  }
  return sum / slice.columns;
}

/// The band holds no signal of this slice though the reference has some there.
bool band_missing(const SliceFigures& slice, const SliceFigures& reference, int row, bool lives) {
  const bool reference_lives = !band_one_level(reference, row);
  if (!reference_lives) return false;
  if (band_same(slice, reference, row)) return lives;
  const double light = band_mean(reference, row);
  // Clipped or black rows of a clean slice may have one level too, but that of the slice before.
  if (band_one_level(slice, row) && std::abs(band_mean(slice, row) - light) > kOtherLevel * light) return true;
  return light > 2.0 * least_lit(reference.means, reference.full_scale) && band_mean(slice, row) < kBandDark * light;
}

/// Gain that makes a slice as bright as another.
double gain_to(const SliceFigures& slice, const SliceFigures& like) {
  const double ratio = brightness_ratio(slice, like.means);
  return ratio > 0.0 ? 1.0 / ratio : 1.0;
}

/// Correlation of (first - second) with (before - after) over a tile's samples, means removed.
float tile_correlation(const std::uint16_t* before, const std::uint16_t* first, const std::uint16_t* second,
                       const std::uint16_t* after, int count, float before_gain, float second_gain, float after_gain) {
  constexpr std::size_t kLanes = 8;
  std::array<float, kLanes> ab{};
  std::array<float, kLanes> aa{};
  std::array<float, kLanes> bb{};
  std::array<float, kLanes> a_sum{};
  std::array<float, kLanes> b_sum{};
  const int whole = count - count % static_cast<int>(kLanes);
  for (int i = 0; i < whole; i += static_cast<int>(kLanes)) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto at = static_cast<std::size_t>(i) + lane;
      const float a = static_cast<float>(first[at]) - second_gain * static_cast<float>(second[at]);
      const float b = before_gain * static_cast<float>(before[at]) - after_gain * static_cast<float>(after[at]);
      ab[lane] += a * b;
      aa[lane] += a * a;
      bb[lane] += b * b;
      a_sum[lane] += a;
      b_sum[lane] += b;
    }
  }
  const auto total = [](const std::array<float, kLanes>& lanes) {
    double sum = 0.0;
    for (const float lane : lanes) sum += static_cast<double>(lane);
    return sum;
  };
  const double n = std::max(whole, 1);
  const double a_mean = total(a_sum) / n;
  const double b_mean = total(b_sum) / n;
  const double covariance = total(ab) / n - a_mean * b_mean;
  const double product = (total(aa) / n - a_mean * a_mean) * (total(bb) / n - b_mean * b_mean);
  return product > 1e-9 ? static_cast<float>(covariance / std::sqrt(product)) : 0.0F;
}

/// Mean squared difference of the samples, in the light of the first.
double distance(const SliceFigures& a, const SliceFigures& b) {
  const auto gain = static_cast<float>(gain_to(b, a));
  double sum = 0.0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    const float difference = static_cast<float>(a.samples[i]) - gain * static_cast<float>(b.samples[i]);
    sum += static_cast<double>(difference * difference);
  }
  return sum;
}

}  // namespace

double brightness_ratio(const SliceFigures& slice, const std::vector<double>& reference) {
  std::vector<double> ratios;
  ratios.reserve(slice.means.size());
  const double least = least_lit(reference, slice.full_scale);
  const double most = kMostLit * slice.full_scale;
  for (std::size_t tile = 0; tile < slice.means.size(); ++tile) {
    if (reference[tile] < least || reference[tile] > most || slice.means[tile] > most) continue;
    ratios.push_back(slice.means[tile] / reference[tile]);
  }
  if (ratios.size() < 4) return 0.0;
  const double middle = median(ratios);
  double sum = 0.0;
  int count = 0;
  for (const double ratio : ratios) {
    if (std::abs(ratio - middle) > kNearMedian * middle) continue;
    sum += ratio;
    ++count;
  }
  return count > 0 ? sum / count : middle;
}

bool same_samples(const SliceFigures& a, const SliceFigures& b) noexcept { return a.samples == b.samples; }

bool one_level(const SliceFigures& slice) noexcept {
  return std::all_of(slice.samples.begin(), slice.samples.end(),
                     [&slice](std::uint16_t level) { return level == slice.samples.front(); });
}

void LivingRows::compare(const SliceFigures& slice, const SliceFigures& next) {
  if (slice.rows != next.rows || slice.samples.size() != next.samples.size()) return;
  lives_.resize(static_cast<std::size_t>(slice.rows));
  for (int row = 0; row < slice.rows; ++row) {
    if (!band_same(slice, next, row)) lives_[static_cast<std::size_t>(row)] = true;
  }
}

double missing_share(const SliceFigures& slice, const SliceFigures& reference, const LivingRows& rows) {
  const auto missing = [&](int row) { return band_missing(slice, reference, row, rows.lives(row)); };
  int top = 0;
  while (top < slice.rows && missing(top)) ++top;
  if (top == slice.rows) return 0.0;  // nothing is there: another reason
  int bottom = 0;
  while (missing(slice.rows - 1 - bottom)) ++bottom;
  return static_cast<double>(std::max(top, bottom)) / slice.rows;
}

bool OrderFigure::in_order() const noexcept {
  return correlation > kMinCorrelation && significance > kMinOrderSignificance;
}

bool OrderFigure::reversed() const noexcept {
  const bool clear = correlation < -kMinCorrelation && negative_share > kMinNegative;
  return (clear || negative_share > kMinNegativeWeak) && significance < -kMinOrderSignificance;
}

OrderFigure order_of(const SliceFigures& before, const SliceFigures& first, const SliceFigures& second,
                     const SliceFigures& after) {
  const auto gain = [&first](const SliceFigures& slice) { return static_cast<float>(gain_to(slice, first)); };
  const float before_gain = gain(before);
  const float second_gain = gain(second);
  const float after_gain = gain(after);
  double sum = 0.0;
  double squares = 0.0;
  int negative = 0;
  for (int tile = 0; tile < first.tiles(); ++tile) {
    const auto value = static_cast<double>(
        tile_correlation(before.tile_samples(tile), first.tile_samples(tile), second.tile_samples(tile),
                         after.tile_samples(tile), first.samples_per_tile, before_gain, second_gain, after_gain));
    sum += value;
    squares += value * value;
    negative += value < 0.0 ? 1 : 0;
  }
  const double n = std::max(1, first.tiles());
  OrderFigure figure;
  figure.correlation = sum / n;
  figure.negative_share = negative / n;
  const double variance = std::max(0.0, squares / n - figure.correlation * figure.correlation);
  figure.significance = figure.correlation / (std::sqrt(variance / n) + 1e-6);
  return figure;
}

bool exchanged(const SliceFigures& before2, const SliceFigures& before, const SliceFigures& first,
               const SliceFigures& second, const SliceFigures& after, const SliceFigures& after2) {
  if (!order_of(before, first, second, after).reversed()) return false;
  if (!order_of(before2, before, first, second).in_order()) return false;
  if (!order_of(first, second, after, after2).in_order()) return false;
  return distance(before, second) + distance(first, after) <
         kNotFarther * (distance(before, first) + distance(second, after));
}

bool StandstillFigure::stood_still() const noexcept { return share > kLeastStill && std::abs(change) < kMostChange; }

StandstillFigure standstill_of(const SliceFigures& before, const SliceFigures& first, const SliceFigures& second,
                               const SliceFigures& after) {
  const std::array<const SliceFigures*, 4> four{&before, &first, &second, &after};
  std::array<double, 4> gain{};
  for (std::size_t i = 0; i < 4; ++i) gain[i] = gain_to(*four[i], first);
  double products = 0.0;
  double squares = 0.0;
  int still = 0;
  for (int tile = 0; tile < first.tiles(); ++tile) {
    const auto covariance = [&](std::array<std::size_t, 2> one, std::array<std::size_t, 2> other) {
      double product = 0.0;
      double one_sum = 0.0;
      double other_sum = 0.0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(first.samples_per_tile); ++i) {
        const auto grey = [&](std::size_t slice) { return gain[slice] * four[slice]->tile_samples(tile)[i]; };
        const double a = grey(one[0]) - grey(one[1]);
        const double b = grey(other[0]) - grey(other[1]);
        product += a * b;
        one_sum += a;
        other_sum += b;
      }
      const double n = std::max(1, first.samples_per_tile);
      return product / n - one_sum * other_sum / (n * n);
    };
    const double step = covariance({1, 2}, {1, 2});
    const double all = covariance({0, 3}, {0, 3});
    if (!(all > kStillerThanAll * step) || !(covariance({0, 1}, {0, 1}) > kStillerThanBeside * step) ||
        !(covariance({2, 3}, {2, 3}) > kStillerThanBeside * step)) {
      continue;
    }
    products += covariance({1, 2}, {0, 3});
    squares += all;
    ++still;
  }
  StandstillFigure figure;
  figure.share = static_cast<double>(still) / std::max(1, first.tiles());
  if (squares > 0.0) figure.change = products / squares;
  return figure;
}

bool MotionFigure::turned() const noexcept {
  return agreement > kMinAgreement && sharpness < kLeastLoss && tiles >= kMinTiles && direction > kMinDirection &&
         significance > kMinMotionSignificance;
}

bool MotionFigure::moved() const noexcept {
  const bool blurred = agreement > kMinAgreement && sharpness < kMaxLoss;
  const bool agreed = agreement > kFirmAgreement && sharpness < kFirmLoss && share > kFirmShare;
  return turned() || (tiles >= kMinTiles && (blurred || agreed));
}

double MotionFigure::strength() const noexcept { return std::max(direction, -sharpness); }

MotionFigure motion_of(const SliceFigures& before, const SliceFigures& slice, const SliceFigures& after,
                       const std::vector<double>& noise) {
  const std::array<const SliceFigures*, 3> three{&before, &slice, &after};
  std::array<double, 3> gain2{1.0, 1.0, 1.0};
  for (std::size_t i : {std::size_t{0}, std::size_t{2}}) gain2[i] = std::pow(gain_to(*three[i], slice), 2);
  std::array<std::vector<double>, 2> turns;  // of the two crossed pairs of directions
  std::vector<double> losses;
  std::vector<double> agreements;
  const auto before_gain = static_cast<float>(std::sqrt(gain2[0]));
  const auto after_gain = static_cast<float>(std::sqrt(gain2[2]));
  for (int tile = 0; tile < slice.tiles(); ++tile) {
    const auto at = static_cast<std::size_t>(tile);
    const double floor = std::max(noise[at], kRoundingEnergy);
    std::array<double, 3> sharpness{};
    for (std::size_t i = 0; i < 3; ++i) sharpness[i] = gain2[i] * three[i]->sharpness(tile);
    if (!(std::min(sharpness[0], sharpness[2]) > kTexture * floor)) continue;
    for (std::size_t pair = 0; pair < turns.size(); ++pair) {
      std::array<double, 3> ratio{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& energies = three[i]->energies[at];
        const auto above_noise = [&](double energy) { return std::max(gain2[i] * energy - 0.8 * floor, 0.08 * floor); };
        ratio[i] = std::log(above_noise(energies[2 * pair]) / above_noise(energies[2 * pair + 1]));
      }
      turns[pair].push_back(ratio[1] - 0.5 * (ratio[0] + ratio[2]));
    }
    const auto above = [floor](double value) { return std::max(value - floor, 0.02 * floor); };
    // (slice - before) with (slice - after).
    agreements.push_back(static_cast<double>(tile_correlation(slice.tile_samples(tile), slice.tile_samples(tile),
                                                              before.tile_samples(tile), after.tile_samples(tile),
                                                              slice.samples_per_tile, 1.0F, before_gain, after_gain)));
    losses.push_back(std::log(above(sharpness[1])) -
                     0.5 * (std::log(above(sharpness[0])) + std::log(above(sharpness[2]))));
  }
  MotionFigure figure;
  figure.tiles = static_cast<int>(losses.size());
  figure.share = static_cast<double>(figure.tiles) / std::max(1, slice.tiles());
  if (losses.empty()) return figure;
  figure.sharpness = median(losses);
  figure.agreement = median(agreements);
  for (std::vector<double>& turn : turns) {
    const double middle = median(turn);
    std::vector<double> spread(turn.size());
    std::transform(turn.begin(), turn.end(), spread.begin(), [middle](double t) { return std::abs(t - middle); });
    const double error = 1.5 * median(spread) / std::sqrt(static_cast<double>(turn.size())) + 1e-3;
    if (std::abs(middle) <= figure.direction) continue;
    figure.direction = std::abs(middle);
    figure.significance = figure.direction / error;
  }
  return figure;
}

}  // namespace fvd
