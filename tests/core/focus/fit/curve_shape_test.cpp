/// Curves of known exponent, sampled at uneven heights.

#include "core/focus/fit/curve_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "core/focus/fit/row_fit.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

constexpr double kWidth_um = 30.0;  // of every curve

double curve(double exponent, double away_um) {
  const double bend = 4.0 * (std::exp2(1.0 / exponent) - 1.0) / (kWidth_um * kWidth_um);
  return std::pow(1.0 + bend * away_um * away_um, -exponent);
}

/// 30 samples, 10 um apart and up to 0.4 um off.
std::vector<double> uneven_heights() {
  std::vector<double> z_um;
  for (int k = 0; k < 30; ++k) z_um.push_back(10.0 * k + 0.4 * std::sin(2.1 * k));
  return z_um;
}

WorkerPool& pool() {
  static WorkerPool two(2);
  return two;
}

struct Curves {
  std::vector<CurveTuple> tuples;
  std::vector<double> truth_um;
  std::array<std::vector<std::uint16_t>, 9> columns;
  std::vector<std::uint8_t> saturated;

  Curves(double exponent, double noise, int count, const std::vector<double>& z_um) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> height(60.0, 220.0);
    saturated.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const double z = truth_um.emplace_back(height(random));
      std::vector<double> values;
      for (const double at : z_um) values.push_back(curve(exponent, at - z) + noise * normal(random));
      const auto top = std::max_element(values.begin() + 2, values.end() - 2);
      CurveTuple& tuple = tuples.emplace_back();
      tuple.index = static_cast<int>(top - values.begin());
      const auto code = [&](int away) {
        return static_cast<std::uint16_t>(std::lround(50000.0 * std::max(0.0, *(top + away))));
      };
      for (int away = -2; away <= 2; ++away) {
        tuple.share[static_cast<std::size_t>(away + 2)] = static_cast<float>(code(away)) / static_cast<float>(code(0));
      }
      const std::array<std::uint16_t, 9> fields{
          0, 0, code(0), code(-1), code(-2), code(1), code(2), 0, static_cast<std::uint16_t>(tuple.index)};
      for (std::size_t field = 0; field < fields.size(); ++field) columns[field].push_back(fields[field]);
    }
  }
  CurveRow row() {
    return {columns[0].data(), columns[1].data(), columns[2].data(), columns[3].data(), columns[4].data(),
            columns[5].data(), columns[6].data(), columns[7].data(), columns[8].data(), saturated.data()};
  }
  /// RMS error of the five-sample fit, um.
  double rms_um(const std::vector<double>& z_um, VertexBias bias) {
    const auto count = truth_um.size();
    FocusSettings settings;
    settings.min_significance = 0.0;
    const RowFit fit(z_um, settings, PixelFormat::kMono8, PeakMethod::kFiveSample, {bias, 0.0, {}});
    std::vector<float> height_m(count);
    std::vector<float> variance_m2(count);
    std::vector<float> prominence(count);
    std::vector<MaskReasons> mask(count);
    const std::vector<float> nothing(count);
    fit.fit(row(), nothing.data(), nothing.data(), static_cast<int>(count),
            {height_m.data(), variance_m2.data(), prominence.data(), mask.data()});
    double squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(mask[i], 0);
      squares += std::pow(static_cast<double>(height_m[i]) * 1e6 - truth_um[i], 2);
    }
    return std::sqrt(squares / static_cast<double>(count));
  }
};

TEST(CurveShape, FindsTheExponentAndTheWidth) {
  const auto z_um = uneven_heights();
  for (const double exponent : {1.4, 1.7, 2.0}) {
    for (const double noise : {0.0, 0.01}) {
      const CurveShape shape = curve_shape(Curves(exponent, noise, 10000, z_um).tuples, z_um, pool());
      EXPECT_NEAR(shape.exponent, exponent, 0.08) << "noise " << noise;
      EXPECT_NEAR(shape.width_um, kWidth_um, 0.02 * kWidth_um) << "exponent " << exponent << ", noise " << noise;
    }
  }
}

TEST(CurveShape, TakesTheRippleOffTheFit) {
  const auto z_um = uneven_heights();
  for (const double exponent : {1.3, 1.5, 1.7}) {
    Curves curves(exponent, 0.0, 5000, z_um);
    const double before_um = curves.rms_um(z_um, {});
    const double after_um = curves.rms_um(z_um, curve_shape(curves.tuples, z_um, pool()).bias);
    EXPECT_LT(after_um, 0.25 * before_um) << "exponent " << exponent << ", " << before_um << " um before";
  }
}

TEST(CurveShape, DoesNotDependOnTheNumberOfThreads) {
  const auto z_um = uneven_heights();
  const Curves curves(1.5, 0.01, 3000, z_um);
  WorkerPool one(1);
  WorkerPool five(5);
  const CurveShape alone = curve_shape(curves.tuples, z_um, one);
  const CurveShape together = curve_shape(curves.tuples, z_um, five);
  EXPECT_EQ(alone.exponent, together.exponent);
  EXPECT_EQ(alone.width_um, together.width_um);
  EXPECT_EQ(alone.bias.linear, together.bias.linear);
  EXPECT_EQ(alone.bias.cubic, together.bias.cubic);
}

TEST(CurveShape, TakesNoVertexToOrBeyondTheNeighbours) {
  const auto z_um = uneven_heights();
  Curves curves(1.4, 0.2, 5000, z_um);  // hardly a peak left in such noise
  FocusSettings settings;
  settings.min_significance = 0.0;
  settings.min_prominence = 0.0;
  const RowFit fit(z_um, settings, PixelFormat::kMono8, PeakMethod::kFiveSample, {{-0.3F, 1.2F}, 0.0, {}});
  const auto count = curves.truth_um.size();
  std::vector<float> height_m(count);
  std::vector<float> variance_m2(count);
  std::vector<float> prominence(count);
  std::vector<MaskReasons> mask(count);
  const std::vector<float> nothing(count);
  fit.fit(curves.row(), nothing.data(), nothing.data(), static_cast<int>(count),
          {height_m.data(), variance_m2.data(), prominence.data(), mask.data()});
  int beyond_half = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (mask[i] != 0) continue;
    const auto peak = static_cast<std::size_t>(curves.tuples[i].index);
    const double height_um = static_cast<double>(height_m[i]) * 1e6;
    EXPECT_GT(height_um, z_um[peak - 1]);
    EXPECT_LT(height_um, z_um[peak + 1]);
    beyond_half += std::abs(height_um - z_um[peak]) > 7.0 ? 1 : 0;
  }
  EXPECT_GT(beyond_half, 100) << "or nothing was put to the test";
}

TEST(CurveShape, LeavesCurvesAloneThatTheFitIsExactFor) {
  const auto z_um = uneven_heights();
  Curves curves(2.0, 0.0, 5000, z_um);
  EXPECT_LT(curves.rms_um(z_um, curve_shape(curves.tuples, z_um, pool()).bias), 0.02);
}

TEST(CurveShape, IsThatOfTheFitWhereTooFewCurvesTell) {
  const auto z_um = uneven_heights();
  const CurveShape few = curve_shape(Curves(1.4, 0.0, 499, z_um).tuples, z_um, pool());
  EXPECT_EQ(few.exponent, 2.0);
  EXPECT_EQ(few.bias.linear, 0.0F);
  EXPECT_EQ(few.bias.cubic, 0.0F);
  EXPECT_GT(few.width_um, 0.0) << "one curve is enough for a width";
  const CurveShape none = curve_shape({}, z_um, pool());
  EXPECT_EQ(none.exponent, 2.0);
  EXPECT_EQ(none.width_um, 0.0);
}

TEST(CurveShape, PassesOverCurvesWithoutAPeak) {
  // Neighbours as high as the peak, and nothing else.
  std::vector<CurveTuple> tuples(1000);
  for (CurveTuple& tuple : tuples) {
    tuple.index = 5;
    tuple.share = {0.0F, 1.0F, 1.0F, 1.0F, 0.0F};
  }
  const CurveShape shape = curve_shape(tuples, uneven_heights(), pool());
  EXPECT_EQ(shape.exponent, 2.0);
  EXPECT_EQ(shape.width_um, 0.0);
}

}  // namespace
}  // namespace fvd
