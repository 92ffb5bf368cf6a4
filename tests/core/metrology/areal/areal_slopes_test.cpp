#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "areal_surfaces.hpp"

namespace fvd::metrology::testing {
namespace {

using enum ArealParameter;

/// A rough, steep field with single holes, a larger hole and a region of no simple shape.
struct RoughField {
  HeightField field;
  Region region;

  RoughField() : region(61, 47) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    field = make_field(61, 47, 1.25, 0.75, [&](double x, double y) {
      const double z_um = 2.0 * std::sin(x / 4.0) + 3.0 * std::cos(x / 9.0 + y / 3.0) + 0.3 * normal(random);
      return normal(random) > 1.8 || std::hypot(x - 30.0, y - 20.0) < 4.0 ? kHole : z_um;
    });
    for (int y = 0; y < 47; ++y) {
      for (int x = 0; x < 61; ++x) region.at(x, y) = 3 * y + 2 * x > 20 && 2 * y - x < 60 ? 1 : 0;
    }
  }

  [[nodiscard]] std::optional<long double> at(int x, int y) const {
    if (x < 0 || y < 0 || x >= 61 || y >= 47 || !is_inside(region, x, y) || field.is_hole(x, y)) return std::nullopt;
    return field.z_um.at(x, y);
  }
};

/// The slope at 0 of the polynomial through the values at -reach .. reach, by the derivatives of its Lagrange terms.
std::optional<long double> polynomial_slope(const RoughField& rough, int x, int y, int dx, int dy, int reach) {
  long double slope = 0.0L;
  for (int i = -reach; i <= reach; ++i) {
    const auto z = rough.at(x + i * dx, y + i * dy);
    if (!z) return std::nullopt;
    long double derivative = 0.0L;
    for (int m = -reach; m <= reach; ++m) {
      if (m == i) continue;
      long double product = 1.0L / (i - m);
      for (int k = -reach; k <= reach; ++k) {
        if (k != i && k != m) product *= static_cast<long double>(-k) / (i - k);
      }
      derivative += product;
    }
    slope += derivative * *z;
  }
  return slope;
}

std::optional<long double> widest_slope(const RoughField& rough, int x, int y, int dx, int dy) {
  for (const int reach : {3, 2, 1}) {
    if (const auto slope = polynomial_slope(rough, x, y, dx, dy, reach)) return slope;
  }
  return std::nullopt;
}

using Point = std::array<long double, 3>;

long double triangle_area(const Point& a, const Point& b, const Point& c) {
  const Point u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Point v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return 0.5L * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

TEST(ArealSlopes, TakesTheWidestDifferenceThatFits) {
  const RoughField rough;
  long double squares = 0.0L;
  int points = 0;
  for (int y = 0; y < 47; ++y) {
    for (int x = 0; x < 61; ++x) {
      const auto slope_x = widest_slope(rough, x, y, 1, 0);
      const auto slope_y = widest_slope(rough, x, y, 0, 1);
      if (!rough.at(x, y) || !slope_x || !slope_y) continue;
      squares += *slope_x * *slope_x / (1.25L * 1.25L) + *slope_y * *slope_y / (0.75L * 0.75L);
      ++points;
    }
  }
  ASSERT_GT(points, 1000);

  const double sdq = AllValues(rough.field, rough.region).number(kSdq);

  const auto expected = static_cast<double>(std::sqrt(squares / points));
  EXPECT_NEAR(sdq, expected, 1e-12 * expected);
}

TEST(ArealSlopes, AveragesBothCutsOfEveryCellWithoutHoles) {
  const RoughField rough;
  long double area = 0.0L;
  long double flat = 0.0L;
  for (int y = 0; y < 46; ++y) {
    for (int x = 0; x < 60; ++x) {
      const auto corner = [&](int dx, int dy) { return rough.at(x + dx, y + dy); };
      if (!corner(0, 0) || !corner(1, 0) || !corner(0, 1) || !corner(1, 1)) continue;
      const Point a = {0.0L, 0.0L, *corner(0, 0)};
      const Point b = {1.25L, 0.0L, *corner(1, 0)};
      const Point c = {0.0L, 0.75L, *corner(0, 1)};
      const Point d = {1.25L, 0.75L, *corner(1, 1)};
      area +=
          0.5L * (triangle_area(a, b, d) + triangle_area(a, c, d) + triangle_area(a, b, c) + triangle_area(b, c, d));
      flat += 1.25L * 0.75L;
    }
  }

  const double sdr = AllValues(rough.field, rough.region).number(kSdr);

  const auto expected = static_cast<double>(100.0L * (area / flat - 1.0L));
  EXPECT_NEAR(sdr, expected, 1e-12 * expected);
}

TEST(ArealSlopes, KeepsTheDigitsOfShallowSlopes) {
  const AllValues values(make_field(50, 50, 1.0, 1.0, [](double x, double) { return 1e-6 * x; }));

  EXPECT_NEAR(values.number(kSdr), 50.0 * 1e-12, 1e-8 * 50.0 * 1e-12);
}

TEST(ArealSlopes, DifferentiatesPolynomialsOfTheSixthDegreeExactly) {
  // Only the point in the middle of a cross of seven points each has slopes in x and in y.
  HeightField cross = make_field(7, 7, 1.0, 1.0, [](double x, double y) {
    const double from_x = x - 3.5;
    const double from_y = y - 3.5;
    if (from_x != 0.0 && from_y != 0.0) return kHole;
    return 2.0 * from_x + std::pow(from_x, 5) - 3.0 * from_y + std::pow(from_y, 6);
  });

  EXPECT_NEAR(AllValues(cross).number(kSdq), std::sqrt(13.0), 1e-12);
}

TEST(ArealSlopes, AreAbsentWhereNoDifferenceFits) {
  const AllValues column(make_field(1, 50, 1.0, 1.0, [](double, double y) { return y; }));
  const AllValues two_rows(make_field(50, 2, 1.0, 1.0, [](double x, double) { return x; }));

  EXPECT_EQ(column[kSdq].reason, "no point has valid neighbours on both sides in x and in y");
  EXPECT_EQ(column[kSdr].reason, "no four neighbouring points are valid");
  EXPECT_FALSE(two_rows[kSdq].value);
  EXPECT_NEAR(two_rows.number(kSdr), 100.0 * (std::sqrt(2.0) - 1.0), 1e-12);
}

}  // namespace
}  // namespace fvd::metrology::testing
