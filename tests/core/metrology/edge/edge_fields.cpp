#include "tests/core/metrology/edge/edge_fields.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/metrology/uncertainty/noise_map.hpp"

namespace fvd::metrology::edge_test {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr int kFine = 5;

// The section: height over s, apex at 0.
double section_height(const WedgeTruth& truth, double s) {
  const double rake = truth.rake_deg * kRadians;
  const double clearance = truth.clearance_deg * kRadians;
  const double ax = truth.s_gamma_um * std::cos(rake);
  const double bx = truth.s_alpha_um * std::cos(clearance);
  if (s <= -ax) return s * std::tan(rake);
  if (s >= bx) return -s * std::tan(clearance);
  const double w = truth.weight;
  const double a = s * (2.0 - 2.0 * w) + ax - bx;
  const double b = s * (2.0 * w - 2.0) - 2.0 * ax;
  const double c = s + ax;
  const double u = 2.0 * c / (-b + std::sqrt(b * b - 4.0 * a * c));
  const double v = 1.0 - u;
  return -(v * v * ax * std::tan(rake) + u * u * bx * std::tan(clearance)) / (v * v + 2.0 * u * v * w + u * u);
}

// Means over `size` neighbours along x and along y, of a grid that is kept only where all of them are there.
std::vector<double> box_mean(const std::vector<double>& fine, int width, int height, int size, int step, int columns,
                             int rows) {
  std::vector<double> along_x(static_cast<std::size_t>(columns) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int column = 0; column < columns; ++column) {
      double sum = 0.0;
      for (int i = 0; i < size; ++i) sum += fine[static_cast<std::size_t>(y * width + column * step + i)];
      along_x[static_cast<std::size_t>(y * columns + column)] = sum / size;
    }
  }
  std::vector<double> result(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      double sum = 0.0;
      for (int i = 0; i < size; ++i) sum += along_x[static_cast<std::size_t>((row * step + i) * columns + column)];
      result[static_cast<std::size_t>(row * columns + column)] = sum / size;
    }
  }
  return result;
}

}  // namespace

void WedgeTruth::set_circle(double radius_um) {
  const double half = (180.0 - rake_deg - clearance_deg) / 2.0 * kRadians;
  s_gamma_um = s_alpha_um = radius_um / std::tan(half);
  weight = std::sin(half);
}

double WedgeTruth::height_um(double x_um, double y_um) const {
  const double e_x = std::cos(direction_deg * kRadians);
  const double e_y = std::sin(direction_deg * kRadians);
  const double dx = x_um - middle_x_um;
  const double dy = y_um - middle_y_um;
  double along = dx * e_x + dy * e_y;
  double across = dx * e_y - dy * e_x;
  if (bend_per_um != 0.0) {
    // The edge is a circle that bends towards the clearance.
    const double radius = 1.0 / bend_per_um;
    const double from_centre = std::hypot(across - radius, along);
    along = radius * std::atan2(along, radius - across);
    across = radius - from_centre;
  }
  const double stretch = std::sqrt(1.0 + tilt * tilt);
  double height = section_height(*this, across);
  if (std::abs(along - notch_along_um) < notch_width_um / 2.0) height = std::fmin(height, -notch_depth_um);
  return apex_z_um + tilt * along + stretch * height;
}

HeightField make_field(const WedgeTruth& truth, int width, int height, int window_px, double sigma_um,
                       std::uint64_t seed) {
  const int fine_width = (width + window_px - 1) * kFine;
  const int fine_height = (height + window_px - 1) * kFine;
  std::vector<double> fine(static_cast<std::size_t>(fine_width) * static_cast<std::size_t>(fine_height));
  const double first = -(window_px - 1) / 2.0 + 0.5 / kFine;
  for (int y = 0; y < fine_height; ++y) {
    for (int x = 0; x < fine_width; ++x) {
      fine[static_cast<std::size_t>(y * fine_width + x)] =
          truth.height_um(first + static_cast<double>(x) / kFine, first + static_cast<double>(y) / kFine);
    }
  }
  const std::vector<double> mean = box_mean(fine, fine_width, fine_height, window_px * kFine, kFine, width, height);
  HeightField field;
  field.z_um = Plane<double>(width, height);
  field.sigma_um = Plane<float>(width, height, static_cast<float>(sigma_um > 0.0 ? sigma_um : 0.1));
  field.kernel.weights.assign(static_cast<std::size_t>(window_px), 1.0 / window_px);
  for (std::size_t i = 0; i < mean.size(); ++i) field.z_um.pixels()[i] = mean[i];
  if (sigma_um > 0.0) {
    NoiseMaps noise(field, seed);
    Plane<double> noisy(width, height);
    noise.add_to_heights(0, noisy);
    field.z_um = std::move(noisy);
  }
  return field;
}

}  // namespace fvd::metrology::edge_test
