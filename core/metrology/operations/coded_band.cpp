#include "core/metrology/operations/coded_band.hpp"

#include <algorithm>
#include <cmath>

#include "core/metrology/operations/window_order.hpp"

namespace fvd::metrology {
namespace {

constexpr double kStepsPerDifference = 64.0;  ///< of neighbouring points, by their median
constexpr double kStepsPerRange = 60000.0;    ///< from the 1st to the 99th percentile: nearly all codes there are

/// The value below which `share` of the values lie; the order of the values changes.
double quantile(std::vector<double>& values, double share) {
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

std::int16_t code_of(double z_um, double middle_um, double per_step) {
  const double steps = std::clamp(std::floor((z_um - middle_um) * per_step), -1.0 * kLastCode, 1.0 * kLastCode);
  return std::isnan(z_um) ? kHoleCode : static_cast<std::int16_t>(steps);
}

}  // namespace

CodedBand::CodedBand(const HeightField& field, int first, int end, int reach)
    : first_(first),
      reach_(reach),
      rows_(end - first + 2 * reach),
      codes_(static_cast<std::size_t>(field.width()) * static_cast<std::size_t>(rows_), kHoleCode) {
  choose_step(field, end);
  const double per_step = 1.0 / step_um_;
  for (int row = std::max(first - reach, 0); row < std::min(end + reach, field.height()); ++row) {
    const double* z = field.z_um.row(row);
    std::int16_t* codes = codes_.data() + (row - first + reach);
    for (int column = 0; column < field.width(); ++column, codes += rows_) {
      *codes = code_of(z[column], middle_um_, per_step);
    }
  }
}

void CodedBand::choose_step(const HeightField& field, int end) {
  std::vector<double> heights;
  std::vector<double> differences;
  for (int row = first_; row < end; row += 8) {
    const double* z = field.z_um.row(row);
    for (int column = 0; column + 1 < field.width(); column += 7) {
      if (std::isnan(z[column])) continue;
      heights.push_back(z[column]);
      if (!std::isnan(z[column + 1])) differences.push_back(std::abs(z[column + 1] - z[column]));
    }
  }
  if (heights.empty()) return;
  middle_um_ = quantile(heights, 0.5);
  const double range_um = quantile(heights, 0.99) - quantile(heights, 0.01);
  const double difference_um = differences.empty() ? 0.0 : quantile(differences, 0.5);
  const double step_um = std::max(difference_um / kStepsPerDifference, range_um / kStepsPerRange);
  if (step_um > 0.0) step_um_ = step_um;
}

}  // namespace fvd::metrology
