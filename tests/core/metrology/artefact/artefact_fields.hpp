#pragma once

/// Artefacts as a focus window shows them: averaged over a box, with noise that neighbours share.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/uncertainty/random_normal.hpp"

namespace fvd::metrology::testing {

inline constexpr int kBox_px = 9;
inline constexpr int kParts = 2;  ///< of a pixel, each way

/// The share of a part of a pixel that lies inside of an edge, its middle so far inside: sums over a box are exact
/// along the axes.
inline double inside(double distance_px) { return std::clamp(distance_px * kParts + 0.5, 0.0, 1.0); }

/// Mean over a box of the padded plane; the result is smaller by kBox_px - 1.
inline Plane<double> boxed(const Plane<double>& plane) {
  Plane<double> rows(plane.width() - kBox_px + 1, plane.height());
  for (int y = 0; y < rows.height(); ++y) {
    for (int x = 0; x < rows.width(); ++x) {
      for (int k = 0; k < kBox_px; ++k) rows.at(x, y) += plane.at(x + k, y) / kBox_px;
    }
  }
  Plane<double> result(rows.width(), rows.height() - kBox_px + 1);
  for (int y = 0; y < result.height(); ++y) {
    for (int k = 0; k < kBox_px; ++k) {
      for (int x = 0; x < result.width(); ++x) result.at(x, y) += rows.at(x, y + k) / kBox_px;
    }
  }
  return result;
}

/// What surface(column, row) is in the mean over the pixels of a box; column 0 is the centre of the first pixel.
inline HeightField seen(int width, int height, const std::function<double(double, double)>& surface) {
  Plane<double> truth(width + kBox_px - 1, height + kBox_px - 1);
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      for (int part = 0; part < kParts * kParts; ++part) {
        const double right = (part % kParts + 0.5) / kParts - 0.5;
        const double down = (part / kParts + 0.5) / kParts - 0.5;
        truth.at(x, y) += surface(x - kBox_px / 2 + right, y - kBox_px / 2 + down) / (kParts * kParts);
      }
    }
  }
  return {boxed(truth), {}, 1.0, 1.0, {std::vector<double>(kBox_px, 1.0 / kBox_px)}};
}

/// Noise of the standard deviation, shared over the box.
inline void add_noise(HeightField& field, double sd_um, std::uint64_t seed) {
  Plane<double> white(field.width() + kBox_px - 1, field.height() + kBox_px - 1);
  RandomNormal random(seed);
  for (double& value : white.pixels()) value = sd_um * kBox_px * random.normal();
  const Plane<double> noise = boxed(white);
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) field.z_um.at(x, y) += noise.at(x, y);
  }
}

inline void add_holes(HeightField& field, double share, std::uint64_t seed) {
  RandomNormal random(seed);
  for (double& z : field.z_um.pixels()) {
    if (random.uniform() < share) z = std::numeric_limits<double>::quiet_NaN();
  }
}

inline void make_hole(HeightField& field, int first_x, int end_x, int first_y, int end_y) {
  for (int y = first_y; y < end_y; ++y) {
    for (int x = first_x; x < end_x; ++x) field.z_um.at(x, y) = std::numeric_limits<double>::quiet_NaN();
  }
}

inline HeightField mirrored(const HeightField& field) {
  HeightField result = field.clone();
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) result.z_um.at(x, y) = field.z_um.at(field.width() - 1 - x, y);
  }
  return result;
}

}  // namespace fvd::metrology::testing
