#pragma once

/// The rounded bottom of a groove in one trace: a circle or a parabola by least squares along z.

#include <array>
#include <optional>
#include <span>

#include "core/metrology/step/groove_step.hpp"

namespace fvd::metrology {

/// x along the trace and z, both in um.
struct TracePoint {
  double x_um = 0.0;
  double z_um = 0.0;
};

/// A curve that is lowest at (x0, z0) with the curvature there, open to the top. With u = x - x0:
/// parabola z0 + c u^2 / 2; circle z0 + c u^2 / (1 + sqrt(1 - c^2 u^2)).
class BottomCurve {
 public:
  /// Absent where there are under three places, or the points are not curved to the top. context: pure.
  [[nodiscard]] static std::optional<BottomCurve> fit(std::span<const TracePoint> points, BottomForm form);

  [[nodiscard]] double z_um(double x_um) const;
  /// Where the curve runs along a line of that slope: its deepest place below it.
  [[nodiscard]] double vertex_um(double steepness) const;
  /// Of curvature, at a place.
  [[nodiscard]] double radius_um(double x_um) const;
  /// Change of z_um(at_um) per change of the height of a point of the fit at x_um. Residuals are taken to be small.
  [[nodiscard]] double influence(double at_um, double x_um) const;

 private:
  using Vector = std::array<double, 3>;
  [[nodiscard]] bool reaches(std::span<const TracePoint> points) const;
  [[nodiscard]] double slope(double x_um) const;
  [[nodiscard]] Vector gradient(double x_um) const;  // of z to x0, z0, curvature
  [[nodiscard]] double squares(std::span<const TracePoint> points) const;
  /// One step of Gauss and Newton, halved until it does not make the fit worse. False where it moves nothing any more.
  bool improve(std::span<const TracePoint> points);

  BottomForm form_ = BottomForm::kCircle;
  double x0_um_ = 0.0;
  double z0_um_ = 0.0;
  double curvature_ = 0.0;
  std::array<Vector, 3> inverse_{};  // of the normal equations
};

}  // namespace fvd::metrology
