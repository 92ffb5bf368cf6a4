#include "core/metrology/operations/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/operations/bands.hpp"
#include "core/metrology/operations/coded_band.hpp"
#include "core/metrology/operations/masking.hpp"
#include "core/metrology/operations/window_order.hpp"

namespace fvd::metrology {
namespace {

constexpr double kMadToSigma = 1.4826;  ///< of a normal distribution: 1 / 0.67449

struct Counts {
  std::size_t judged = 0;
  std::size_t few_valid = 0;
  std::size_t no_scale = 0;
};

void check(const OutlierSettings& settings) {
  if (settings.window_px < 3 || settings.window_px > 31 || settings.window_px % 2 == 0) {
    throw Error(ErrorCode::kBadRecipe, "the window of `outliers` must be an odd number from 3 to 31 pixels");
  }
  if (!(settings.limit > 0.0) || !std::isfinite(settings.limit)) {
    throw Error(ErrorCode::kBadRecipe, "the limit of `outliers` must be greater than 0");
  }
}

/// The median of the values, whose order changes; not empty.
double median_of(std::vector<double>& values) {
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*std::max_element(values.begin(), upper) + *upper);
}

/// Slides the window along the rows of one band. Codes rule out nearly all points; the rest is decided on the heights.
/// context: one thread.
class BandJudge {
 public:
  BandJudge(const HeightField& field, const OutlierSettings& settings, int first, int end)
      : field_(field),
        settings_(settings),
        reach_(settings.window_px / 2),
        band_(field, first, end, reach_),
        order_(settings.window_px),
        no_column_(static_cast<std::size_t>(settings.window_px), kHoleCode) {}

  void judge(int row, std::uint8_t* is_outlier, Counts& counts) {
    order_.clear();
    for (int column = 0; column < std::min(reach_, field_.width()); ++column) enter(column, row);
    const int rows = std::min(row + reach_, field_.height() - 1) - std::max(row - reach_, 0) + 1;
    for (int column = 0; column < field_.width(); ++column) {
      enter(column + reach_, row);
      is_outlier[column] = 0;
      if (band_.code(column, row) == kHoleCode) continue;
      const int columns = std::min(column + reach_, field_.width() - 1) - std::max(column - reach_, 0) + 1;
      if (2 * order_.valid() < rows * columns) {
        ++counts.few_valid;
        continue;
      }
      ++counts.judged;
      is_outlier[column] = !is_near(column, row) && is_far(column, row, counts) ? 1 : 0;
    }
  }

 private:
  /// Takes the place of the column that has left the window.
  void enter(int column, int row) {
    order_.replace_column(column % settings_.window_px,
                          column < field_.width() ? band_.around(column, row) : no_column_.data());
  }

  [[nodiscard]] double sigma_um(int column, int row) const {
    return field_.has_sigma() ? static_cast<double>(field_.sigma_um.at(column, row)) : 0.0;
  }

  /// True only where the point is no outlier whatever the heights behind the codes. A height lies within one step above
  /// its code, so that two of them differ by at most one step more than their codes; one more step is for rounding.
  [[nodiscard]] bool is_near(int column, int row) {
    const int here = band_.code(column, row);
    if (std::abs(here) == kLastCode) return false;
    const double allowed_steps = settings_.limit * sigma_um(column, row) / band_.step_um();
    const int allowed = static_cast<int>(std::min(allowed_steps, 2.0 * kLastCode)) - 2;
    if (allowed > 0 && 2 * count_between(here - allowed, here + allowed) > order_.valid()) {
      return true;  // so many are within limit * sigma that their median is
    }
    const auto [lower, upper] = order_.middle();
    const int steps = std::max(std::abs(here - lower), std::abs(here - upper)) + 2;
    // Over half of the points farther from the median than this: the MAD is too large for an outlier.
    const int needed = static_cast<int>(std::min(steps / (settings_.limit * kMadToSigma), 1e6)) + 3;
    if (lower - needed <= -kLastCode || upper + needed >= kLastCode) return false;
    return order_.count_between(lower - needed, upper + needed) < order_.valid() / 2;
  }

  /// Without the outermost codes, behind which there may be any height.
  [[nodiscard]] int count_between(int from, int to) const {
    return order_.count_between(std::max(from, 1 - kLastCode), std::min(to, kLastCode - 1));
  }

  /// The rule itself.
  [[nodiscard]] bool is_far(int column, int row, Counts& counts) {
    const double here = field_.z_um.at(column, row);
    std::size_t equal = 0;
    values_.clear();
    for (int y = std::max(row - reach_, 0); y <= std::min(row + reach_, field_.height() - 1); ++y) {
      for (int x = std::max(column - reach_, 0); x <= std::min(column + reach_, field_.width() - 1); ++x) {
        const double z = field_.z_um.at(x, y);
        equal += z == here ? 1U : 0U;
        if (!std::isnan(z)) values_.push_back(z);
      }
    }
    if (2 * equal > values_.size()) return false;  // it is the median
    const double median = median_of(values_);
    for (double& value : values_) value = std::abs(value - median);
    const double mad = median_of(values_);
    const double distance = std::abs(here - median);
    const double sigma = sigma_um(column, row);
    if (mad == 0.0 && sigma == 0.0) {
      if (distance > 0.0) ++counts.no_scale;
      return false;
    }
    return distance > settings_.limit * std::max(kMadToSigma * mad, sigma);
  }

  const HeightField& field_;
  const OutlierSettings& settings_;
  int reach_;
  CodedBand band_;
  WindowOrder order_;
  std::vector<std::int16_t> no_column_;  ///< beyond the border
  std::vector<double> values_;
};

Counts sum_of(const std::vector<Counts>& bands) {
  Counts sum;
  for (const Counts& counts : bands) {
    sum.judged += counts.judged;
    sum.few_valid += counts.few_valid;
    sum.no_scale += counts.no_scale;
  }
  return sum;
}

}  // namespace

OperationReport remove_outliers(HeightField& field, const OutlierSettings& settings, Plane<MaskReasons>* reasons,
                                WorkerPool* pool) {
  check(settings);
  Plane<std::uint8_t> is_outlier = Plane<std::uint8_t>::unset(field.width(), field.height());
  std::vector<Counts> bands(static_cast<std::size_t>(band_count(field.height())));
  run_bands(pool, field.height(), [&](int band, int first, int end) {
    BandJudge judge(field, settings, first, end);
    for (int row = first; row < end; ++row) {
      judge.judge(row, is_outlier.row(row), bands[static_cast<std::size_t>(band)]);
    }
  });
  const Counts counts = sum_of(bands);

  OperationReport report;
  report.points_used = counts.judged;
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      if (is_outlier.at(column, row) == 0) continue;
      make_hole(field, column, row, reasons, mask_reason::kOutlier);
      ++report.points_removed;
    }
  }
  report.values = {{"window_px", static_cast<double>(settings.window_px), std::nullopt},
                   {"limit", settings.limit, std::nullopt},
                   {"undecided_few_valid", static_cast<double>(counts.few_valid), std::nullopt},
                   {"undecided_no_scale", static_cast<double>(counts.no_scale), std::nullopt}};
  if (counts.no_scale > 0) {
    report.warnings.emplace_back("points differ from neighbourhoods of equal heights, which have no scale to judge by");
  }
  return report;
}

}  // namespace fvd::metrology
