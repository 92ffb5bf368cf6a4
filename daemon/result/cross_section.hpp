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
  double from_x_um = 0.0;
  double from_y_um = 0.0;
  double to_x_um = 0.0;
  double to_y_um = 0.0;
  double band_width_um = 0.0;  ///< across the line; what lies in it is averaged
  std::vector<Region> regions;

  [[nodiscard]] double length_um() const;
  bool operator==(const CrossSection&) const = default;
};

}  // namespace fvd
