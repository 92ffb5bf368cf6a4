#pragma once

/// Where a measurement looked at the surface, as a line with regions that pictures show.

#include <string>
#include <vector>

namespace fvd {

/// In um from the outer corner of pixel (0, 0), x right, y down.
struct CrossSection {
  struct Region {
    std::string name;
    double from_um = 0.0;  ///< along the line
    double to_um = 0.0;
    bool operator==(const Region&) const = default;
  };
  /// A line over the section, in measured heights.
  struct Curve {
    std::vector<double> along_um;
    std::vector<double> z_um;  ///< as many
    bool operator==(const Curve&) const = default;
  };
  double from_x_um = 0.0;
  double from_y_um = 0.0;
  double to_x_um = 0.0;
  double to_y_um = 0.0;
  double band_width_um = 0.0;  ///< across the line; what lies in it is averaged
  std::vector<Region> regions;
  std::string fit_name = {};    ///< what the curves are, for people; empty = there is none
  std::vector<Curve> fit = {};  ///< what was fitted, at most some hundred points

  [[nodiscard]] double length_um() const;
  bool operator==(const CrossSection&) const = default;
};

}  // namespace fvd
