#pragma once

/// Triangles between the valid points of a surface.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "daemon/export/surface_view.hpp"

namespace fvd {

struct MeshPoint {
  int x = 0;
  int y = 0;
};

/// Corners, counter-clockwise as seen from the camera where y points up.
using MeshTriangle = std::array<MeshPoint, 3>;

/// Calls use(triangle) for all triangles, cell by cell: two where all four points of the cell are valid, one where
/// three are, else none.
template <typename Use>
void for_each_triangle(const PlaneView<const float>& height_m, const Use& use) {
  const auto valid = [&height_m](const MeshPoint& point) { return !std::isnan(height_m.at(point.x, point.y)); };
  for (int y = 0; y + 1 < height_m.height; ++y) {
    for (int x = 0; x + 1 < height_m.width; ++x) {
      const MeshPoint a{x, y};
      const MeshPoint b{x + 1, y};
      const MeshPoint c{x, y + 1};
      const MeshPoint d{x + 1, y + 1};
      const int holes = (valid(a) ? 0 : 1) + (valid(b) ? 0 : 1) + (valid(c) ? 0 : 1) + (valid(d) ? 0 : 1);
      if (holes > 1) continue;
      if (!valid(b)) {
        use(MeshTriangle{a, c, d});
      } else if (!valid(c)) {
        use(MeshTriangle{a, d, b});
      } else {
        if (valid(a)) use(MeshTriangle{a, c, b});
        if (valid(d)) use(MeshTriangle{b, c, d});
      }
    }
  }
}

/// Places of points in mm: x right, y up from the lower border, z towards the camera; points stand in the middle of
/// their pixels. The surface outlives it.
class MeshPlaces {
 public:
  explicit MeshPlaces(const SurfaceView& surface) : height_m_(surface.height_m) {
    constexpr double kMiddle = 0.5;
    for (int x = 0; x < height_m_.width; ++x) x_mm_.push_back(mm((x + kMiddle) * surface.pitch_x_um.value()));
    for (int y = 0; y < height_m_.height; ++y) {
      y_mm_.push_back(mm((height_m_.height - kMiddle - y) * surface.pitch_y_um.value()));
    }
  }
  [[nodiscard]] std::array<float, 3> operator()(const MeshPoint& point) const {
    constexpr double kMillimetresPerMetre = 1e3;
    const double z_mm = static_cast<double>(height_m_.at(point.x, point.y)) * kMillimetresPerMetre;
    return {x_mm_[static_cast<std::size_t>(point.x)], y_mm_[static_cast<std::size_t>(point.y)],
            static_cast<float>(z_mm)};
  }

 private:
  static float mm(double um) { return static_cast<float>(um * 1e-3); }

  PlaneView<const float> height_m_;
  std::vector<float> x_mm_;
  std::vector<float> y_mm_;
};

}  // namespace fvd
