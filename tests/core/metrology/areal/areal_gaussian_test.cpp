#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "areal_surfaces.hpp"
#include "core/metrology/real_fft.hpp"

namespace fvd::metrology::testing {
namespace {

using enum ArealParameter;

/// A Gaussian surface of Sq 1 with the autocorrelation exp(-r^2 / length^2): white noise of which only the phases are
/// kept, with the power spectrum of the wanted function.
HeightField gaussian_surface(int size, double pitch_um, double length_um, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  RealFft fft(size, size);
  for (double& value : fft.plane()) value = normal(random);
  fft.forward();
  const int columns = size / 2 + 1;
  for (int v = 0; v < size; ++v) {
    const double ky = 2.0 * kPi * (v <= size / 2 ? v : v - size) / (size * pitch_um);
    for (int u = 0; u < columns; ++u) {
      const double kx = 2.0 * kPi * u / (size * pitch_um);
      std::complex<double>& bin =
          fft.spectrum()[static_cast<std::size_t>(v) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(u)];
      bin *= std::exp(-(kx * kx + ky * ky) * length_um * length_um / 8.0) / std::abs(bin);
    }
  }
  fft.spectrum()[0] = 0.0;
  fft.inverse();
  double squares = 0.0;
  for (const double value : fft.plane()) squares += value * value;
  const double scale = 1.0 / std::sqrt(squares / static_cast<double>(fft.plane().size()));
  HeightField field;
  field.z_um = Plane<double>(size, size);
  field.pitch_x_um = field.pitch_y_um = pitch_um;
  std::size_t i = 0;
  for (double& z_um : field.z_um.pixels()) z_um = scale * fft.plane()[i++];
  return field;
}

TEST(ArealGaussian, ShowsTheExpectationsOfAGaussianSurface) {
  // Statistical. Two triangles a cell have 0.5 % less area than the surface at ten points in a length.
  const HeightField field = gaussian_surface(2000, 0.4, 4.0, 1);

  const AllValues values(field);

  const double worst =
      std::max({std::abs(values.number(kSdq) / 0.5 - 1.0), std::abs(values.number(kSdr) / 11.31693 - 1.0),
                std::abs(values.number(kSal) / 5.074545 - 1.0)});
  RecordProperty("statistical_07", std::to_string(worst));
  EXPECT_NEAR(values.number(kSq), 1.0, 1e-9);
  EXPECT_NEAR(values.number(kSdq), 0.5, 0.005);
  EXPECT_NEAR(values.number(kSdr), 11.31693, 0.1131693);
  EXPECT_NEAR(values.number(kSal), 5.074545, 0.05074545);
  EXPECT_NEAR(values.number(kStr), 1.0, 0.03);
  EXPECT_NEAR(values.number(kSku), 3.0, 0.1);
  EXPECT_FALSE(values[kStd].value);
}

}  // namespace
}  // namespace fvd::metrology::testing
