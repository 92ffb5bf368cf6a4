#include "core/metrology/operations/lateral.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

/// Where the new points of one row lie among its old ones.
struct RowShift {
  int columns = 0;     ///< whole columns to the left neighbour
  double share = 0.0;  ///< of the way from the left to the right neighbour, 0 <= share < 1
};

/// A share that rounding alone has made counts as none, so that no neighbour is asked for without need.
RowShift row_shift(double shift_px) {
  constexpr double kNone_px = 1e-9;
  double whole = std::floor(shift_px);
  double share = shift_px - whole;
  if (share > 1.0 - kNone_px) {
    whole += 1.0;
    share = 0.0;
  }
  if (share < kNone_px) share = 0.0;
  return {static_cast<int>(whole), share};
}

class Resampler {
 public:
  Resampler(const HeightField& from, const Plane<MaskReasons>* reasons) : from_(from), reasons_(reasons) {}

  /// Writes the point of `column` and `row`; true where a hole came about that was none at this pixel.
  bool write(HeightField& to, Plane<MaskReasons>* to_reasons, int column, int row, RowShift shift) const {
    const int left = column + shift.columns;
    const double right_share = shift.share;
    const bool needs_right = right_share > 0.0;
    double& z = to.z_um.at(column, row);
    z = height(left, row);
    if (needs_right) z = (1.0 - right_share) * z + right_share * height(left + 1, row);
    const bool hole = std::isnan(z);
    if (to.has_sigma()) {
      float& sigma = to.sigma_um.at(column, row);
      sigma = hole ? std::numeric_limits<float>::quiet_NaN() : mean_sigma(left, row, static_cast<float>(right_share));
    }
    if (to_reasons != nullptr) {
      to_reasons->at(column, row) = hole ? reasons_of_hole(left, row, needs_right) : MaskReasons{0};
    }
    return hole && !from_.is_hole(column, row);
  }

 private:
  [[nodiscard]] bool in_view(int column) const { return column >= 0 && column < from_.width(); }
  [[nodiscard]] double height(int column, int row) const {
    return in_view(column) ? from_.z_um.at(column, row) : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] float mean_sigma(int left, int row, float right_share) const {
    const float sigma = from_.sigma_um.at(left, row);
    if (right_share == 0.0F) return sigma;
    return (1.0F - right_share) * sigma + right_share * from_.sigma_um.at(left + 1, row);
  }
  [[nodiscard]] MaskReasons reasons_at(int column, int row) const {
    return in_view(column) ? reasons_->at(column, row) : mask_reason::kOutOfView;
  }
  [[nodiscard]] MaskReasons reasons_of_hole(int left, int row, bool needs_right) const {
    const MaskReasons right = needs_right ? reasons_at(left + 1, row) : MaskReasons{0};
    return static_cast<MaskReasons>(reasons_at(left, row) | right);
  }

  const HeightField& from_;
  const Plane<MaskReasons>* reasons_;
};

void check(const LateralCalibration& calibration) {
  const auto is_pitch = [](double pitch_um) { return pitch_um > 0.0 && std::isfinite(pitch_um); };
  if (!is_pitch(calibration.pitch_x_um) || !is_pitch(calibration.pitch_y_um)) {
    throw Error(ErrorCode::kBadInput, "the pitch of a lateral calibration must be greater than 0 um");
  }
  if (!(std::abs(calibration.shear) < 0.1)) {
    throw Error(ErrorCode::kBadInput, "the shear of a lateral calibration must lie between -0.1 and 0.1");
  }
}

/// The number of points that were lost.
std::size_t undo_shear(HeightField& field, double shear, Plane<MaskReasons>* reasons) {
  HeightField straight = field.clone();
  Plane<MaskReasons> straight_reasons = reasons != nullptr ? reasons->clone() : Plane<MaskReasons>();
  Plane<MaskReasons>* to_reasons = reasons != nullptr ? &straight_reasons : nullptr;
  const Resampler resampler(field, reasons);
  std::size_t lost = 0;
  for (int row = 0; row < field.height(); ++row) {
    // x = (column + 0.5) * pitch + shear * y is asked for (column' + 0.5) * pitch: the old point lies shear * y before.
    const RowShift shift = row_shift(-shear * field.y_um(row) / field.pitch_x_um);
    for (int column = 0; column < field.width(); ++column) {
      if (resampler.write(straight, to_reasons, column, row, shift)) ++lost;
    }
  }
  field = std::move(straight);
  if (reasons != nullptr) *reasons = std::move(straight_reasons);
  return lost;
}

}  // namespace

OperationReport lateral(HeightField& field, const LateralCalibration& calibration, Plane<MaskReasons>* reasons) {
  check(calibration);
  field.pitch_x_um = calibration.pitch_x_um;
  field.pitch_y_um = calibration.pitch_y_um;
  const bool resample = std::abs(calibration.shear) > kLargestShearLeft;
  OperationReport report;
  if (resample) report.points_removed = undo_shear(field, calibration.shear, reasons);
  const double left_um = resample ? 0.0 : std::abs(calibration.shear) * field.pitch_y_um * field.height();
  report.values = {{"pitch_x_um", field.pitch_x_um, std::nullopt},
                   {"pitch_y_um", field.pitch_y_um, std::nullopt},
                   {"shear", calibration.shear, std::nullopt},
                   {"resampled", resample ? 1.0 : 0.0, std::nullopt},
                   {"shift_left_um", left_um, std::nullopt}};
  return report;
}

}  // namespace fvd::metrology
