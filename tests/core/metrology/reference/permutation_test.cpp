#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/operations/region.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/region_step.hpp"
#include "tests/core/metrology/areal/areal_surfaces.hpp"

namespace fvd::metrology::reference {
namespace {

using enum ArealParameter;
using metrology::testing::AllValues;
using metrology::testing::make_field;

struct Part {
  HeightField field;
  Region region;  ///< empty = everything
};

/// The part with the point of (x, y) taken from from(x, y).
Part moved(const Part& part, int width, int height, bool transposed,
           const std::function<std::pair<int, int>(int, int)>& from) {
  Part result;
  result.field.z_um = Plane<double>(width, height);
  result.field.pitch_x_um = transposed ? part.field.pitch_y_um : part.field.pitch_x_um;
  result.field.pitch_y_um = transposed ? part.field.pitch_x_um : part.field.pitch_y_um;
  if (!part.region.empty()) result.region = Region(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto [column, row] = from(x, y);
      result.field.z_um.at(x, y) = part.field.z_um.at(column, row);
      if (!part.region.empty()) result.region.at(x, y) = part.region.at(column, row);
    }
  }
  return result;
}

Part transposed(const Part& part) {
  return moved(part, part.field.height(), part.field.width(), true, [](int x, int y) { return std::pair{y, x}; });
}
Part mirrored_in_x(const Part& part) {
  const int last = part.field.width() - 1;
  return moved(part, part.field.width(), part.field.height(), false, [last](int x, int y) {
    return std::pair{last - x, y};
  });
}
Part mirrored_in_y(const Part& part) {
  const int last = part.field.height() - 1;
  return moved(part, part.field.width(), part.field.height(), false, [last](int x, int y) {
    return std::pair{x, last - y};
  });
}
Part cropped(const Part& part, int left, int top, int right, int bottom) {
  return moved(part, part.field.width() - left - right, part.field.height() - top - bottom, false, [=](int x, int y) {
    return std::pair{x + left, y + top};
  });
}

/// A rough part with holes, which a step of 50 um along x parts in three; the region is round.
Part part_with_step() {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Part part;
  part.field = make_field(240, 130, 0.9, 1.2, [&](double x, double y) {
    const double z = 100.0 + 0.02 * x - 0.01 * y + std::sin(0.5 * x + 0.8 * y) + 0.1 * normal(random);
    return normal(random) > 2.0 ? metrology::testing::kHole : z - (std::abs(x - 108.0) < 27.0 ? 50.0 : 0.0);
  });
  part.region = Region(240, 130);
  for (int y = 0; y < 130; ++y) {
    for (int x = 0; x < 240; ++x) part.region.at(x, y) = std::hypot(x - 50.0, y - 60.0) < 45.0 ? 1 : 0;
  }
  return part;
}

template <typename T>
T given(StepOutcome<T> outcome) {
  if (const auto* refusal = std::get_if<StepRefusal>(&outcome))
    ADD_FAILURE() << step_refusal_name(refusal->code) << ": " << refusal->text;
  return std::get<T>(std::move(outcome));
}

/// The worst of what must not differ, relative, and the worst of order statistics and counts.
struct Worst {
  double relative = 0.0;
  double exact = 0.0;

  void compare(double value, double wanted) {
    relative = std::max(relative, std::abs(value - wanted) / std::max(std::abs(wanted), 1e-300));
  }
  void count(double value, double wanted) { exact = std::max(exact, std::abs(value - wanted)); }
};

void compare_textures(const Part& part, const Part& other, Worst& worst) {
  const AllValues expected(part.field, part.region);
  const AllValues actual(other.field, other.region);
  worst.count(static_cast<double>(actual.evaluation().points), static_cast<double>(expected.evaluation().points));
  for (const ArealParameterInfo& info : areal_parameters()) {
    if (info.parameter == kStd || info.parameter == kSmr) continue;  // Std turns with the surface
    const bool has = expected[info.parameter].value.has_value();
    EXPECT_EQ(actual[info.parameter].value.has_value(), has) << info.name;
    if (!has) continue;
    worst.compare(actual.number(info.parameter), expected.number(info.parameter));
    if (info.parameter == kSz || info.parameter == kSxp) {
      worst.count(actual.number(info.parameter), expected.number(info.parameter));
    }
  }
}

struct Steps {
  GrooveStep groove;
  RegionStep between;
};

Steps steps_of(const HeightField& field, bool along_y, double left_um, double top_um, bool mirrored) {
  GrooveSettings settings;
  settings.across = along_y ? Across::kY : Across::kX;
  settings.edges = GrooveEdges{81.0 - left_um, 135.0 - left_um};
  settings.band = FromTo{12.0 - top_um, 144.0 - top_um};
  const Grid grid = grid_of(field);
  const auto rectangle = [&](double from_um, double to_um) {
    const RectangleUm across{from_um - left_um, 12.0 - top_um, to_um - from_um, 132.0};
    return rectangle_region(grid, along_y ? RectangleUm{across.y, across.x, across.height, across.width} : across);
  };
  const Region land = mirrored ? rectangle(146.7, 207.9) : rectangle(8.1, 69.3);
  const Region bottom = rectangle(90.0, 126.0);
  return {given(iso5436_a1(field, settings)),
          given(step_between(field, {"bottom", &bottom}, {"land", &land}, StepSlope::kCommonPlane))};
}

void compare_steps(const Steps& expected, const Steps& actual, Worst& worst) {
  worst.compare(actual.groove.mean.height_um, expected.groove.mean.height_um);
  worst.compare(actual.groove.areal.height_um, expected.groove.areal.height_um);
  worst.compare(actual.groove.plain_means_um, expected.groove.plain_means_um);
  // A scatter keeps the digits of the heights that it is the difference of.
  const double mean = expected.groove.mean.height_um;
  worst.compare(mean + actual.groove.traces.sd_um, mean + expected.groove.traces.sd_um);
  worst.compare(actual.between.value.height_um, expected.between.value.height_um);
  worst.count(actual.groove.mean.points, expected.groove.mean.points);
  worst.count(actual.groove.areal.points, expected.groove.areal.points);
  worst.count(actual.between.value.points, expected.between.value.points);
}

TEST(Permutation, ChangesNoValueOfTextureOrStep) {
  const Part part = part_with_step();
  Worst worst;

  compare_textures(part, transposed(part), worst);
  compare_textures(part, mirrored_in_x(part), worst);
  compare_textures(part, mirrored_in_y(part), worst);
  compare_textures(part, cropped(part, 4, 10, 100, 20), worst);
  const Steps steps = steps_of(part.field, false, 0.0, 0.0, false);
  compare_steps(steps, steps_of(transposed(part).field, true, 0.0, 0.0, false), worst);
  compare_steps(steps, steps_of(mirrored_in_x(part).field, false, 0.0, 0.0, true), worst);
  compare_steps(steps, steps_of(mirrored_in_y(part).field, false, 0.0, 0.0, false), worst);
  compare_steps(steps, steps_of(cropped(part, 4, 10, 2, 5).field, false, 3.6, 12.0, false), worst);

  std::array<char, 32> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "%.3e", worst.relative));
  RecordProperty("permutation_worst", text.data());
  RecordProperty("permutation_worst_of_counts", std::to_string(worst.exact));
  EXPECT_LT(worst.relative, 1e-12);
  EXPECT_EQ(worst.exact, 0.0);
}

}  // namespace
}  // namespace fvd::metrology::reference
