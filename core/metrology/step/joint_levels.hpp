#pragma once

/// Levels of several groups of points with one common slope, by least squares.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/uncertainty/weight_map.hpp"

namespace fvd::metrology {

/// Groups of points within a rectangle of a field.
struct PointGroups {
  int left = 0;  ///< column of the field that is column 0 here
  int top = 0;
  Plane<std::uint8_t> group;  ///< 0 = none, 1..count; points that are holes of the field do not count
  int count = 0;              ///< 1 or more
};

enum class SlopeAxes {
  kNone,  ///< the surface is levelled: no slope
  kX,     ///< along x only, for a trace of one row
  kY,
  kBoth,
};

/// z = a x + b y + c_g: the fit, in terms of each group's centre.
class JointLevels {
 public:
  /// from: the groups whose points decide about the slope, by number (1..); empty = all, which is the joint fit.
  /// Absent where a group has no point or the groups in `from` do not define the slope.
  [[nodiscard]] static std::optional<JointLevels> fit(const HeightField& field, const PointGroups& groups,
                                                      SlopeAxes axes, const std::vector<int>& from = {});

  [[nodiscard]] double slope_x() const { return slope_[0]; }
  [[nodiscard]] double slope_y() const { return slope_[1]; }
  [[nodiscard]] int points(int group) const { return centres_.at(index(group)).points; }
  [[nodiscard]] double mean_z_um(int group) const { return centres_.at(index(group)).z_um; }
  [[nodiscard]] double mean_x_um(int group) const { return centres_.at(index(group)).x_um; }
  [[nodiscard]] double mean_y_um(int group) const { return centres_.at(index(group)).y_um; }
  /// c_upper - c_lower: the difference along z, positive where `upper` lies higher.
  [[nodiscard]] double difference_um(int upper, int lower) const;
  /// The standard error of that difference over the one it would have with a known slope, for independent points.
  [[nodiscard]] double correlation_factor(int upper, int lower) const;

  /// Weights of the quantity whose derivatives are `per_difference` to difference_um(upper, lower) and `per_slope` to
  /// the slopes. field, groups: as in the fit.
  [[nodiscard]] WeightMap weights(const HeightField& field, const PointGroups& groups, int upper, int lower,
                                  double per_difference, std::array<double, 2> per_slope) const;

 private:
  struct Centre {
    int points = 0;
    double x_um = 0.0;
    double y_um = 0.0;
    double z_um = 0.0;
    bool decides = true;  // about the slope
  };
  [[nodiscard]] static std::size_t index(int group) { return static_cast<std::size_t>(group - 1); }
  [[nodiscard]] std::array<double, 2> slope_change(double x, double y) const;  // inverse scatter times (x, y)
  bool invert(const std::array<double, 3>& scatter, SlopeAxes axes);

  std::vector<Centre> centres_;
  std::array<double, 2> slope_{};
  std::array<double, 3> inverse_{};  // of the scatter about the centres: xx, xy, yy
};

}  // namespace fvd::metrology
