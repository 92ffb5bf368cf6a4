#pragma once

/// Places and directions in the image, um from its middle.

#include <cmath>
#include <numbers>

#include "sim/artefact/artefact_parameters.hpp"

namespace fvd::sim {

struct Place {
  double x_um = 0.0;
  double y_um = 0.0;
};

[[nodiscard]] inline double radians(double deg) { return deg * std::numbers::pi / 180.0; }
[[nodiscard]] inline double degrees(double rad) { return rad * 180.0 / std::numbers::pi; }

/// The axes of a direction. Whole quarters of a turn are exact, so that what lies along pixels stays there.
class Directed {
 public:
  explicit Directed(double direction_deg)
      : cos_(std::cos(radians(direction_deg))), sin_(std::sin(radians(direction_deg))) {
    if (std::abs(cos_) < kExact) cos_ = 0.0;
    if (std::abs(sin_) < kExact) sin_ = 0.0;
  }
  [[nodiscard]] double along(const Place& p) const { return p.x_um * cos_ + p.y_um * sin_; }
  [[nodiscard]] double across(const Place& p) const { return p.x_um * sin_ - p.y_um * cos_; }
  [[nodiscard]] double along(const Tilt& t) const { return t.slope_x * cos_ + t.slope_y * sin_; }
  [[nodiscard]] double across(const Tilt& t) const { return t.slope_x * sin_ - t.slope_y * cos_; }
  [[nodiscard]] Place at(double along_um, double across_um) const {
    return {along_um * cos_ + across_um * sin_, along_um * sin_ - across_um * cos_};
  }

 private:
  static constexpr double kExact = 1e-15;
  double cos_;
  double sin_;
};

}  // namespace fvd::sim
