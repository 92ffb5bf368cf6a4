#include "core/metrology/areal/autocorrelation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "areal_surfaces.hpp"
#include "core/metrology/areal/texture_direction.hpp"

namespace fvd::metrology::testing {
namespace {

using enum ArealParameter;

/// Waves in many directions, stretched in x, with holes.
HeightField waves_with_holes() {
  std::mt19937 random(23);
  std::normal_distribution<double> normal;
  std::array<std::array<double, 4>, 40> waves{};
  for (auto& wave : waves) {
    for (double& number : wave) number = normal(random);
  }
  return make_field(72, 64, 1.0, 1.5, [&](double x, double y) {
    double z_um = 0.0;
    for (const auto& wave : waves) z_um += wave[0] * std::sin(0.14 * wave[1] * x + 0.22 * wave[2] * y + 6.0 * wave[3]);
    return normal(random) > 1.3 || (x > 60.0 && y > 80.0) ? kHole : z_um;
  });
}

struct DirectLag {
  long double mean = 0.0L;  // of the products, over the mean square
  int pairs = 0;
};

/// The function at a lag by adding the products.
DirectLag direct_lag(const HeightField& field, int lag_x, int lag_y) {
  long double mean = 0.0L;
  int points = 0;
  for (const double z_um : field.z_um.pixels()) {
    if (std::isnan(z_um)) continue;
    mean += z_um;
    ++points;
  }
  mean /= points;
  long double squares = 0.0L;
  long double products = 0.0L;
  DirectLag lag;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (field.is_hole(x, y)) continue;
      squares += (field.z_um.at(x, y) - mean) * (field.z_um.at(x, y) - mean);
      const int to_x = x + lag_x;
      const int to_y = y + lag_y;
      if (to_x < 0 || to_x >= field.width() || to_y < 0 || to_y >= field.height() || field.is_hole(to_x, to_y))
        continue;
      products += (field.z_um.at(x, y) - mean) * (field.z_um.at(to_x, to_y) - mean);
      ++lag.pairs;
    }
  }
  if (lag.pairs > 0) lag.mean = products / lag.pairs / (squares / points);
  return lag;
}

Autocorrelation autocorrelation_of(const HeightField& field) {
  return Autocorrelation(cut_region(field, {}), AllValues(field).evaluation().mean_um);
}

TEST(Autocorrelation, AgreesWithAddingTheProductsOfEveryPair) {
  const HeightField field = waves_with_holes();
  const int points = direct_lag(field, 0, 0).pairs;

  const Autocorrelation function = autocorrelation_of(field);

  int absent = 0;
  for (int lag_y = -63; lag_y < 64; lag_y += 3) {
    for (int lag_x = -71; lag_x < 72; lag_x += 3) {
      const DirectLag direct = direct_lag(field, lag_x, lag_y);
      const std::optional<double> value = function.at(lag_x, lag_y);
      ASSERT_EQ(value.has_value(), 4 * direct.pairs >= points) << lag_x << ' ' << lag_y;
      absent += value ? 0 : 1;
      if (!value) continue;
      ASSERT_NEAR(*value, static_cast<double>(direct.mean), 1e-13) << lag_x << ' ' << lag_y;
    }
  }
  EXPECT_GT(absent, 100);
}

TEST(Autocorrelation, UsesLagsWithExactlyAQuarterOfThePairs) {
  const Autocorrelation function = autocorrelation_of(make_field(8, 40, 1.0, 1.0, [](double x, double) { return x; }));

  EXPECT_EQ(function.max_lag_x(), 6);
  EXPECT_EQ(function.max_lag_y(), 30);
  EXPECT_TRUE(function.at(6, 0));
  EXPECT_TRUE(function.at(0, -30));
  EXPECT_TRUE(function.at(-4, 20));
  EXPECT_FALSE(function.at(6, 1));
  EXPECT_FALSE(function.at(7, 0));
}

TEST(Autocorrelation, IsACubicBetweenLags) {
  const HeightField field = waves_with_holes();
  const Autocorrelation function = autocorrelation_of(field);
  const auto neville = [](std::array<double, 4> p, double t) {
    for (int order = 1; order < 4; ++order) {
      for (int i = 0; i + order < 4; ++i) {
        const double from = i;
        const double to = i + order;
        const auto at = static_cast<std::size_t>(i);
        p[at] = ((to - t) * p[at] + (t - from) * p[at + 1]) / (to - from);
      }
    }
    return p[0];
  };
  // At (3.3, top + 0.8) pixels; the first row of lags needs those of the other half of the plane.
  for (const int top : {0, 2}) {
    std::array<double, 4> rows{};
    for (int j = 0; j < 4; ++j) {
      std::array<double, 4> row{};
      for (int i = 0; i < 4; ++i) row[static_cast<std::size_t>(i)] = function.at(2 + i, top - 1 + j).value();
      rows[static_cast<std::size_t>(j)] = neville(row, 1.3);
    }

    EXPECT_NEAR(function.at_um(3.3, (top + 0.8) * 1.5).value(), neville(rows, 1.8), 1e-13) << top;
  }
  EXPECT_EQ(function.at_um(-3.3, -2.8 * 1.5), function.at_um(3.3, 2.8 * 1.5));
  EXPECT_NEAR(function.at_um(-4.0, 3.0).value(), function.at(-4, 2).value(), 1e-15);
}

TEST(AutocorrelationLengths, AreTheExtremesOfAllDirections) {
  const HeightField field = waves_with_holes();
  const Autocorrelation function = autocorrelation_of(field);
  double shortest_um = 1e9;
  double longest_um = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double fall_um = function.fall_um(kPi * i / 20000, 0.2).value();
    shortest_um = std::min(shortest_um, fall_um);
    longest_um = std::max(longest_um, fall_um);
  }

  const AllValues values(field);

  EXPECT_NEAR(values.number(kSal), shortest_um, 1e-6 * shortest_um);
  EXPECT_NEAR(values.number(kStr), shortest_um / longest_um, 1e-6);
  EXPECT_LT(values.number(kStr), 0.9);
}

TEST(AutocorrelationLengths, FollowTheThreshold) {
  const HeightField field = make_field(300, 300, 1.0, 1.0, [](double x, double y) {
    return std::sin(2.0 * kPi * x / 100.0 + kPi / 4.0) * std::sin(2.0 * kPi * y / 100.0 + kPi / 4.0);
  });

  const AllValues values(field, {}, {.acf_threshold = 0.5});

  EXPECT_NEAR(values.number(kSal), 100.0 / 6.0, 1e-5);
  EXPECT_NEAR(values.number(kStr), (1.0 / 6.0) / (std::sqrt(2.0) / 8.0), 1e-6);
}

TEST(AutocorrelationLengths, TellTheDirectionAsItIsSeen) {
  // A lay that goes up to the right.
  const HeightField field = make_field(200, 200, 1.0, 1.0, [](double x, double y) { return std::sin((x + y) / 4.0); });

  const std::string reason = AllValues(field)[kStr].reason;

  const auto at = reason.find("direction of ");
  ASSERT_NE(at, std::string::npos) << reason;
  EXPECT_NEAR(std::stod(reason.substr(at + 13)), 45.0, 3.0) << reason;
}

TEST(TextureDirection, IsThatOfTheLayAsItIsSeen) {
  for (const double wavelength_um : {4.0, 16.0}) {
    for (const double deg : {0.3, 17.0, 45.0, 90.0, 123.4, 178.0}) {
      // Along the lay x grows and y falls, for y goes down.
      const double across_x = std::sin(deg * kPi / 180.0);
      const double across_y = std::cos(deg * kPi / 180.0);
      const HeightField field = make_field(300, 260, 0.8, 1.1, [&](double x, double y) {
        return std::sin(2.0 * kPi * (across_x * x + across_y * y) / wavelength_um);
      });

      EXPECT_NEAR(texture_direction_deg(cut_region(field, {})).value.value_or(kHole), deg, 0.02) << deg;
    }
  }
}

TEST(TextureDirection, BearsHoles) {
  const HeightField field = make_field(300, 260, 0.8, 1.1, [&](double x, double y) {
    return x > 100.0 && x < 110.0 ? kHole : std::sin(0.4 * x + 0.3 * y);
  });

  EXPECT_NEAR(AllValues(field).number(kStd), 180.0 / kPi * std::atan2(0.4, 0.3), 0.3);
}

TEST(TextureDirection, SaysThatTwoDirectionsTie) {
  const HeightField field = make_field(400, 400, 1.25, 1.25, [](double x, double y) {
    return std::sin(2.0 * kPi * x / 25.0 + 0.7) * std::sin(2.0 * kPi * y / 25.0 + 0.7);
  });

  const ArealValue direction = AllValues(field)[kStd];

  EXPECT_NEAR(direction.value.value_or(kHole), 45.0, 0.01);
  EXPECT_TRUE(direction.tie);
}

TEST(TextureDirection, IsAbsentWithoutALayOrWithoutRoom) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const AllValues noise(make_field(200, 200, 1.0, 1.0, [&](double, double) { return normal(random); }));
  const AllValues narrow(make_field(7, 200, 1.0, 1.0, [&](double, double) { return normal(random); }));

  EXPECT_EQ(noise[kStd].reason, "no direction has twice the mean power of all directions");
  EXPECT_EQ(narrow[kStd].reason, "the region has fewer than 8 columns or rows");
}

}  // namespace
}  // namespace fvd::metrology::testing
