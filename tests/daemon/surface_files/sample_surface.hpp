#pragma once

/// A small surface that looks different from every side.

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/surface/surface.hpp"

namespace fvd::test {

/// 7 x 5 points, holes at (2, 0) and (6, 4); every height differs, some are below 0.
inline Surface sample_surface() {
  Surface surface;
  surface.height_m = Plane<float>(7, 5);
  surface.sigma_m = Plane<float>(7, 5, 0.25e-6F);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x)
      surface.height_m.at(x, y) = 1e-6F * (static_cast<float>(x * x) - 3.7F * static_cast<float>(y));
  }
  for (const auto& [x, y] : {std::pair{2, 0}, std::pair{6, 4}}) {
    surface.height_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    surface.sigma_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
  }
  surface.pitch_x_um = 0.48;
  surface.pitch_y_um = 0.51;
  surface.title = "part <7> & \"co\"";
  return surface;
}

/// Bit for bit, but all NaN are alike.
inline void expect_same_heights(const Plane<float>& got, const Plane<float>& expected) {
  ASSERT_EQ(got.width(), expected.width());
  ASSERT_EQ(got.height(), expected.height());
  for (int y = 0; y < got.height(); ++y) {
    for (int x = 0; x < got.width(); ++x) {
      const float a = got.at(x, y);
      const float b = expected.at(x, y);
      const bool same = (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
      EXPECT_TRUE(same) << "(" << x << ", " << y << "): " << a << ", expected " << b;
    }
  }
}

}  // namespace fvd::test
