#include "tests/core/metrology/reference/areal_cases.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

#include "core/metrology/areal/autocorrelation.hpp"
#include "core/metrology/areal/region_heights.hpp"
#include "core/metrology/operations/level.hpp"

namespace fvd::metrology::reference {
namespace {

using enum ArealParameter;
using metrology::testing::AllValues;
using metrology::testing::make_field;

// Cut by borders where slope squared and height squared are at their means, see areal_reference_test.cpp.
constexpr long double kEighth = kPi / 4.0L;

void compare_moments(ReferenceCase& reference, const AllValues& values, const Moments& exact, const Moments& closed,
                     double bound) {
  const auto compare = [&](const char* name, ArealParameter parameter, long double own, long double printed) {
    reference.compare(name, values.number(parameter), own, static_cast<double>(printed), bound, 1.0);
  };
  compare("Sa", kSa, exact.sa, closed.sa);
  compare("Sq", kSq, exact.sq, closed.sq);
  compare("Ssk", kSsk, exact.ssk, closed.ssk);
  compare("Sku", kSku, exact.sku, closed.sku);
  compare("Sz", kSz, exact.sz, closed.sz);
}

void compare_material(ReferenceCase& reference, const AllValues& values, const Material& exact, const Material& closed,
                      double bound) {
  const auto compare = [&](const char* name, ArealParameter parameter, long double own, long double printed,
                           double scale) {
    reference.compare(name, values.number(parameter), own, static_cast<double>(printed), scale * bound, scale);
  };
  compare("Sk", kSk, exact.sk, closed.sk, 1.0);
  compare("Spk", kSpk, exact.spk, closed.spk, 1.0);
  compare("Svk", kSvk, exact.svk, closed.svk, 1.0);
  compare("Smr1", kSmr1, exact.smr1, closed.smr1, 10.0);
  compare("Smr2", kSmr2, exact.smr2, closed.smr2, 10.0);
  compare("Vmp", kVmp, exact.vmp, closed.vmp, 1.0);
  compare("Vmc", kVmc, exact.vmc, closed.vmc, 1.0);
  compare("Vvc", kVvc, exact.vvc, closed.vvc, 1.0);
  compare("Vvv", kVvv, exact.vvv, closed.vvv, 1.0);
  compare("Sxp", kSxp, exact.sxp, closed.sxp, 1.0);
}

TEST(ArealCase, OneIsASinusoid) {
  constexpr int kPoints = 2000;
  constexpr int kRows = 8;
  ReferenceCase reference(1, kPoints * kRows);
  const long double step = 2.0L * kPi / kPoints;
  std::vector<long double> heights;
  for (int i = 0; i < kPoints; ++i) heights.push_back(5.0L * std::sin(step * (i + 0.5L) + kEighth));
  const AllValues values(make_field(kPoints, kRows, 100.0 / kPoints, 1.0, [](double x, double) {
    return static_cast<double>(5.0L * std::sin(2.0L * kPi * static_cast<long double>(x) / 100.0L + kEighth));
  }));

  compare_moments(reference, values, moments_of(heights), {3.183099L, 3.535534L, 0.0L, 1.5L, 10.0L}, 2e-5);
  compare_material(
      reference, values, material_of(heights),
      {8.637288L, 0.0L, 1.799273L, 0.0L, 75.92982L, 0.01628756L, 4.155270L, 4.645098L, 0.1264723L, 4.984587L}, 1e-4);
  EXPECT_TRUE(values[kSk].tie);
  EXPECT_FALSE(values[kStr].value);

  long double slopes = 0.0L;
  int counted = 0;
  for (int i = 0; i < kPoints; ++i) {
    const int order = order_at(i, kPoints);
    if (order == 0) continue;
    const long double slope = std::cos(step * (i + 0.5L) + kEighth) * difference_gain(order, step);
    slopes += std::pow(5.0L * 2.0L * kPi / 100.0L * slope, 2);
    ++counted;
  }
  reference.compare("Sdq", values.number(kSdq), std::sqrt(slopes / counted), 0.2221441, 1e-6);
  long double area = 0.0L;
  for (int i = 0; i + 1 < kPoints; ++i) {
    const long double rise = 10.0L * std::cos(step * (i + 1) + kEighth) * std::sin(step / 2.0L);
    area += std::hypot(1.0L, rise * kPoints / 100.0L) - 1.0L;
  }
  reference.compare("Sdr", values.number(kSdr), 100.0L * area / (kPoints - 1), 2.423523, 3e-5);
}

TEST(ArealCase, OneHasAnAutocorrelation) {
  constexpr int kPoints = 1000;
  ReferenceCase reference(1, kPoints);
  std::vector<long double> heights;
  for (int i = 0; i < kPoints; ++i) heights.push_back(5.0L * std::sin(2.0L * kPi * (i + 0.5L) / 200.0L + kEighth));
  const HeightField field = make_field(kPoints, 100, 0.5, 5.0, [](double x, double) {
    return static_cast<double>(5.0L * std::sin(2.0L * kPi * static_cast<long double>(x) / 100.0L + kEighth));
  });
  const Autocorrelation function(cut_region(field, {}), 0.0);
  const std::vector<long double> correlation = autocorrelation_of(heights, 60);

  long double low = 0.0L;
  long double high = 50.0L;
  for (int i = 0; i < 70; ++i) {
    const long double middle = (low + high) / 2.0L;
    (between_lags(correlation, middle) > 0.2L ? low : high) = middle;
  }

  reference.compare("fall in x", function.fall_um(0.0, 0.2).value_or(-1.0), low / 2.0L, 21.79529, 5e-6);
}

TEST(ArealCase, TwoIsATriangleOrARamp) {
  constexpr int kPoints = 2000;
  ReferenceCase reference(2, kPoints);
  const Moments moments{2.5L, 2.886751L, 0.0L, 1.8L, 10.0L};
  const Material material{10.0L, 0.0L, 0.0L, 0.0L, 100.0L, 0.05L, 3.15L, 3.85L, 0.2L, 4.75L};
  std::vector<long double> ramp;
  std::vector<long double> triangle;
  for (int i = 0; i < kPoints; ++i) {
    ramp.push_back(10.0L * (i + 0.5L) / kPoints);
    triangle.push_back(i < kPoints / 2 ? 20.0L * (i + 0.5L) / kPoints : 20.0L - 20.0L * (i + 0.5L) / kPoints);
  }
  const auto field_of = [](const std::vector<long double>& heights) {
    return make_field(kPoints, 1, 1.0, 1.0,
                      [&](double x, double) { return static_cast<double>(heights[static_cast<std::size_t>(x)]); });
  };

  const AllValues of_ramp(field_of(ramp));
  const AllValues of_triangle(field_of(triangle));

  compare_moments(reference, of_ramp, moments_of(ramp), moments, 0.0051);
  compare_material(reference, of_ramp, material_of(ramp), material, 2e-5);
  compare_moments(reference, of_triangle, moments_of(triangle), moments, 0.0101);
  compare_material(reference, of_triangle, material_of(triangle), material, 2e-5);
}

TEST(ArealCase, ThreeAreTwoLevels) {
  ReferenceCase reference(3, 2000);
  for (const int top : {50, 25}) {
    std::vector<long double> heights;
    for (int i = 0; i < 100; ++i) heights.push_back(i < top ? 10.0L : 0.0L);

    const AllValues values(make_field(100, 20, 1.0, 1.0, [&](double x, double) { return x < top ? 10.0 : 0.0; }));

    const Moments closed =
        top == 50 ? Moments{5.0L, 5.0L, 0.0L, 1.0L, 10.0L} : Moments{3.75L, 4.330127L, 1.154701L, 2.333333L, 10.0L};
    compare_moments(reference, values, moments_of(heights), closed, 5e-7);
  }
}

TEST(ArealCase, FourHasNormalHeights) {
  constexpr int kPoints = 4000;
  ReferenceCase reference(4, kPoints);
  const boost::math::normal_distribution<long double> normal;
  std::vector<long double> heights;
  for (int i = 0; i < kPoints; ++i) heights.push_back(boost::math::quantile(normal, (i + 0.5L) / kPoints));

  const AllValues values(make_field(kPoints, 1, 1.0, 1.0, [&](double x, double) {
    return static_cast<double>(heights[static_cast<std::size_t>(x)]);
  }));

  const Moments exact = moments_of(heights);
  // Quantiles have no tails: their bound is O(1/N).
  reference.compare("Sa", values.number(kSa), exact.sa, 0.7978846, 4e-4);
  reference.compare("Sku", values.number(kSku), exact.sku, 3.0, 0.02);
  compare_material(reference, values, material_of(heights),
                   {2.622003L, 0.9369847L, 0.9369847L, 9.492867L, 90.507133L, 0.04734318L, 0.9059157L, 1.2172571L,
                    0.1116377L, 1.959964L},
                   1e-3);
}

TEST(ArealCase, FiveIsAnEggBox) {
  constexpr int kPoints = 800;
  ReferenceCase reference(5, kPoints * kPoints);
  const long double step = 2.0L * kPi / kPoints;
  std::vector<long double> wave;
  std::vector<long double> slope;  // of the wave, by differences of the order that fits
  std::vector<long double> rise;   // to the next point, over the pitch
  for (int i = 0; i < kPoints; ++i) {
    const long double phase = step * (i + 0.5L) + kEighth;
    wave.push_back(std::sin(phase));
    const int order = order_at(i, kPoints);
    slope.push_back(order == 0 ? 0.0L : 2.0L * kPi / 100.0L * std::cos(phase) * difference_gain(order, step));
    rise.push_back(2.0L * std::cos(phase + step / 2.0L) * std::sin(step / 2.0L) * kPoints / 100.0L);
  }
  const AllValues values(make_field(kPoints, kPoints, 0.125, 0.125, [](double x, double y) {
    const auto part = [](double um) { return std::sin(2.0L * kPi * static_cast<long double>(um) / 100.0L + kEighth); };
    return static_cast<double>(5.0L * part(x) * part(y));
  }));

  std::vector<long double> heights;
  long double slopes = 0.0L;
  long double counted = 0.0L;
  long double area = 0.0L;
  for (std::size_t y = 0; y < kPoints; ++y) {
    for (std::size_t x = 0; x < kPoints; ++x) {
      heights.push_back(5.0L * wave[x] * wave[y]);
      if (order_at(static_cast<int>(x), kPoints) > 0 && order_at(static_cast<int>(y), kPoints) > 0) {
        slopes += 25.0L * (std::pow(slope[x] * wave[y], 2) + std::pow(slope[y] * wave[x], 2));
        counted += 1.0L;
      }
      if (x + 1 == kPoints || y + 1 == kPoints) continue;
      for (const std::size_t row : {y, y + 1}) {
        for (const std::size_t column : {x, x + 1}) {
          const long double along_x = 5.0L * rise[x] * wave[row];
          const long double along_y = 5.0L * rise[y] * wave[column];
          area += (std::sqrt(1.0L + along_x * along_x + along_y * along_y) - 1.0L) / 4.0L;
        }
      }
    }
  }
  const Moments moments = moments_of(heights);
  reference.compare("Sa", values.number(kSa), moments.sa, 2.026424, 2e-5);
  reference.compare("Sq", values.number(kSq), moments.sq, 2.5, 1e-9);
  reference.compare("Sku", values.number(kSku), moments.sku, 2.25, 1e-9);
  reference.compare("Sdq", values.number(kSdq), std::sqrt(slopes / counted), 0.2221441, 1e-6);
  reference.compare("Sdr", values.number(kSdr), 100.0L * area / std::pow(kPoints - 1.0L, 2), 2.430607, 5e-5);

  // The function is a product of both directions', so that its extremes lie along the axes and on the diagonal.
  const std::vector<long double> correlation = autocorrelation_of(wave, 300);
  const auto falls_to = [&](long double share) {
    long double low = 0.0L;
    long double high = 250.0L;
    for (int i = 0; i < 70; ++i) {
      const long double middle = (low + high) / 2.0L;
      (between_lags(correlation, middle) > share ? low : high) = middle;
    }
    return low * 100.0L / kPoints;
  };
  const long double along_axis = falls_to(0.2L);
  const long double on_diagonal = std::sqrt(2.0L) * falls_to(std::sqrt(0.2L));
  reference.compare("Sal", values.number(kSal), along_axis, 21.79529, 5e-6);
  reference.compare("Str", values.number(kStr), along_axis / on_diagonal, 0.8746243, 2e-7);
}

TEST(ArealCase, SixIsAPlane) {
  ReferenceCase reference(6, 90 * 70);
  HeightField field = make_field(90, 70, 1.5, 0.5, [](double x, double y) { return 0.1 * x + 0.05 * y; });

  const AllValues tilted(field);
  const OperationReport report = level(field, LevelMethod::kLeastSquares, {});
  const AllValues levelled(field);

  ASSERT_FALSE(report.refused);
  reference.compare("Sdq", tilted.number(kSdq), std::sqrt(0.0125L), 0.1118034, 1e-7);
  reference.compare("Sdr", tilted.number(kSdr), 100.0L * (std::sqrt(1.0125L) - 1.0L), 0.6230590, 5e-8);
  for (const ArealParameter parameter : {kSa, kSq, kSp, kSv, kSz, kSdq, kSdr}) {
    reference.compare("levelled", levelled.number(parameter), 0.0L, 0.0, 0.0, 0.1);
  }
}

}  // namespace
}  // namespace fvd::metrology::reference
