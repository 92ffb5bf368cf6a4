#include "core/metrology/operations/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/operations/bands.hpp"
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

/// Slides the window along rows of one field. context: one thread.
class RowJudge {
 public:
  RowJudge(const HeightField& field, const OutlierSettings& settings)
      : field_(field),
        settings_(settings),
        reach_(settings.window_px / 2),
        order_(settings.window_px),
        column_(static_cast<std::size_t>(settings.window_px)) {}

  void judge(int row, std::uint8_t* is_outlier, Counts& counts) {
    order_.clear();
    for (int column = 0; column < std::min(reach_, field_.width()); ++column) enter(column, row);
    const int rows = std::min(row + reach_, field_.height() - 1) - std::max(row - reach_, 0) + 1;
    for (int column = 0; column < field_.width(); ++column) {
      enter(column + reach_, row);
      is_outlier[column] = 0;
      if (field_.is_hole(column, row)) continue;
      const int columns = std::min(column + reach_, field_.width() - 1) - std::max(column - reach_, 0) + 1;
      if (2 * order_.valid() < rows * columns) {
        ++counts.few_valid;
        continue;
      }
      ++counts.judged;
      is_outlier[column] = is_far(column, row, counts) ? 1 : 0;
    }
  }

 private:
  /// Takes the place of the column that has left the window.
  void enter(int column, int row) {
    for (int i = 0; i < settings_.window_px; ++i) {
      const int y = row - reach_ + i;
      const bool inside = column < field_.width() && y >= 0 && y < field_.height();
      column_[static_cast<std::size_t>(i)] =
          inside ? field_.z_um.at(column, y) : std::numeric_limits<double>::quiet_NaN();
    }
    order_.replace_column(column % settings_.window_px, column_.data());
  }

  [[nodiscard]] bool is_far(int column, int row, Counts& counts) {
    const double median = order_.median();
    const double distance = std::abs(field_.z_um.at(column, row) - median);
    const double sigma = field_.has_sigma() ? static_cast<double>(field_.sigma_um.at(column, row)) : 0.0;
    if (distance <= settings_.limit * sigma) return false;
    // Over half of the points farther from the median than this: the MAD is too large for an outlier. Counting them is
    // far quicker than the MAD; the margin leaves what rounding might decide to the MAD itself.
    const double needed = distance / (settings_.limit * kMadToSigma) * (1.0 + 1e-12);
    if (order_.count_within(median, needed) < order_.valid() / 2) return false;
    const double mad = order_.median_distance(median);
    if (mad == 0.0 && sigma == 0.0) {
      if (distance > 0.0) ++counts.no_scale;
      return false;
    }
    return distance > settings_.limit * kMadToSigma * mad;
  }

  const HeightField& field_;
  const OutlierSettings& settings_;
  int reach_;
  WindowOrder order_;
  std::vector<double> column_;
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
    RowJudge judge(field, settings);
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
