#include "core/focus/fit/gap_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/focus/fit/fit_reference.hpp"
#include "core/focus/fit/gap_bias.hpp"

namespace fvd {
namespace {

constexpr CurveShape kShape{.exponent = 2.0, .width_um = 21.0, .bias = {}};

/// Slices of 10 um with a little error, up or down, the one at 100 um missing.
std::vector<double> heights_um(double direction) {
  std::vector<double> z_um;
  for (int k = 0; k < 21; ++k) {
    if (k != 10) z_um.push_back(direction * (10.0 * k + 0.3 * std::sin(5.0 * k)));
  }
  return z_um;
}

/// Curves whose widths and tails differ from place to place, as textures make them, and their vertices.
struct Curves {
  Curves(const std::vector<double>& z_um, double from_um, double to_um, int count, double width = 1.0,
         double spread = 1.0) {
    const GapBias bias(z_um, kShape);
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(std::min(from_um, to_um), std::max(from_um, to_um));
    for (int n = 0; n < count; ++n) {
      vertices_um.push_back(uniform(random));
      CurveShape shape = kShape;
      const double coarse = normal(random);
      shape.width_um *= width * std::exp(0.08 * spread * coarse);
      shape.exponent *= std::exp(-0.25 * spread * coarse);
      const ScanCurve curve(shape);
      std::vector<double> samples;
      for (const double z : z_um) samples.push_back(curve.at(z - vertices_um.back()) + 0.004 * normal(random));
      const auto peak = std::max_element(samples.begin(), samples.end());
      CurveTuple tuple{.index = static_cast<int>(peak - samples.begin()), .noise = 0.004F};
      for (std::size_t j = 0; j < 5; ++j)
        tuple.share[j] = static_cast<float>(*(peak - 2 + static_cast<int>(j)) / *peak);
      const auto at = [&](int j) {
        return ReferenceSample{z_um[static_cast<std::size_t>(tuple.index + j)],
                               static_cast<double>(tuple.share[static_cast<std::size_t>(2 + j)])};
      };
      const auto fitted =
          fit_reference({.peak = at(0), .left = at(-1), .right = at(1), .left2 = at(-2), .right2 = at(2)});
      CurveRow row{};
      auto index = static_cast<std::uint16_t>(tuple.index);
      row.peak_index = &index;
      auto height_m = static_cast<float>(fitted.value().z_um * 1e-6);
      bias.correct(row, 1, &height_m);
      tuple.height_um = height_m * 1e6F;
      tuples.push_back(tuple);
    }
  }

  template <typename Height>
  [[nodiscard]] double rms(const Height& height_um) const {
    double squares = 0.0;
    for (std::size_t n = 0; n < tuples.size(); ++n) squares += std::pow(height_um(tuples[n]) - vertices_um[n], 2);
    return std::sqrt(squares / static_cast<double>(tuples.size()));
  }

  std::vector<CurveTuple> tuples;
  std::vector<double> vertices_um;
};

double fitted_um(const CurveTuple& tuple) { return static_cast<double>(tuple.height_um); }

TEST(GapFit, LessensTheErrorBesideAGapWhereCurvesDiffer) {
  for (const double direction : {1.0, -1.0}) {
    const auto z_um = heights_um(direction);
    const Curves learnt_from(z_um, direction * 40.0, direction * 160.0, 3000);
    const GapFit gap(learnt_from.tuples, z_um, kShape, {});
    for (const double from_um : {85.0, 105.0}) {
      const Curves beside(z_um, direction * from_um, direction * (from_um + 10.0), 500);
      EXPECT_LT(beside.rms([&](const CurveTuple& tuple) { return gap.height_um(tuple); }),
                0.75 * beside.rms(fitted_um));
    }
  }
}

TEST(GapFit, LeavesTheMiddleOfTheGapAndAllOtherHeightsAlone) {
  const auto z_um = heights_um(1.0);
  const Curves learnt_from(z_um, 40.0, 160.0, 3000);
  const GapFit gap(learnt_from.tuples, z_um, kShape, {});
  for (const auto& [from_um, to_um] : {std::pair{40.0, 84.0}, std::pair{98.0, 102.0}, std::pair{117.0, 160.0}}) {
    for (const CurveTuple& tuple : Curves(z_um, from_um, to_um, 100).tuples) {
      EXPECT_EQ(gap.height_um(tuple), fitted_um(tuple));
    }
  }
  int nearly_in_the_middle = 0;
  for (const CurveTuple& tuple : Curves(z_um, 94.0, 106.0, 1000).tuples) {
    if (std::abs(fitted_um(tuple) - 100.0) > 4.6) continue;
    EXPECT_EQ(gap.height_um(tuple), fitted_um(tuple));
    ++nearly_in_the_middle;
  }
  EXPECT_GT(nearly_in_the_middle, 500);
}

TEST(GapFit, LearnsNothingFromFewCurvesOrWithoutAWidth) {
  const auto z_um = heights_um(1.0);
  const Curves many(z_um, 40.0, 160.0, 3000);
  const Curves beside(z_um, 85.0, 95.0, 50);
  const GapFit from_few(std::span(many.tuples).first(300), z_um, kShape, {});
  const GapFit without_width(many.tuples, z_um, {}, {});
  const GapFit of_spikes(many.tuples, z_um, kShape, {.least_neighbours = 1.9});
  for (const CurveTuple& tuple : beside.tuples) {
    EXPECT_EQ(from_few.height_um(tuple), fitted_um(tuple));
    EXPECT_EQ(without_width.height_um(tuple), fitted_um(tuple));
    EXPECT_EQ(of_spikes.height_um(tuple), fitted_um(tuple));
  }
}

TEST(GapFit, LearnsNothingFromAPlateau) {
  const auto z_um = heights_um(1.0);
  const Curves plateau(z_um, 139.5, 140.5, 3000);
  const GapFit gap(plateau.tuples, z_um, kShape, {});
  for (const CurveTuple& tuple : Curves(z_um, 90.4, 93.0, 200).tuples)
    EXPECT_EQ(gap.height_um(tuple), fitted_um(tuple));
}

TEST(GapFit, TrustsNoCurveThatIsUnlikeTheScans) {
  const auto z_um = heights_um(1.0);
  const Curves learnt_from(z_um, 40.0, 160.0, 3000);
  const GapFit gap(learnt_from.tuples, z_um, kShape, {});
  CurveTuple strange{.index = 9, .share = {0.9F, 0.1F, 1.0F, 0.9F, 0.9F}, .noise = 0.004F, .height_um = 90.5F};
  EXPECT_EQ(gap.height_um(strange), fitted_um(strange));
}

/// A part of the surface with a texture of its own, at the height of the gap.
TEST(GapFit, LeavesCurvesOfAnotherWidthToTheFiveSamples) {
  const auto z_um = heights_um(1.0);
  const Curves learnt_from(z_um, 40.0, 160.0, 3000, 1.0, 0.25);
  const GapFit gap(learnt_from.tuples, z_um, kShape, {});
  const auto height_um = [&](const CurveTuple& tuple) { return gap.height_um(tuple); };
  const Curves alike(z_um, 85.0, 95.0, 500, 1.0, 0.25);
  EXPECT_LT(alike.rms(height_um), 0.85 * alike.rms(fitted_um));
  for (const double width : {0.7, 0.8, 1.25, 1.5}) {
    const Curves others(z_um, 85.0, 115.0, 1500, width, 0.25);
    EXPECT_LT(others.rms(height_um), 1.15 * others.rms(fitted_um)) << width;
  }
}

}  // namespace
}  // namespace fvd
