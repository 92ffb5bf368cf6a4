#include "core/metrology/artefact/grid_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/metrology/artefact/artefact_fields.hpp"

namespace fvd::metrology {
namespace {

using testing::add_holes;
using testing::add_noise;
using testing::inside;
using testing::make_hole;
using testing::mirrored;
using testing::seen;

constexpr int kWidth = 480;
constexpr int kHeight = 360;

struct Grid {
  double pitch_x_px = 60.0;
  double pitch_y_px = 60.0;
  double line_px = 24.0;
  double height_um = 20.0;
  double turn_deg = 0.0;
  double angle_deg = 90.0;
  double column = 239.5;  ///< a crossing
  double row = 179.5;
  double slope_x = 0.0;
  double slope_y = 0.0;

  [[nodiscard]] std::pair<double, double> place(double i, double j) const {
    const double first = turn_deg * M_PI / 180.0;
    const double second = first + angle_deg * M_PI / 180.0;
    return {column + i * pitch_x_px * std::cos(first) + j * pitch_y_px * std::cos(second),
            row + i * pitch_x_px * std::sin(first) + j * pitch_y_px * std::sin(second)};
  }
  [[nodiscard]] double operator()(double x, double y) const {
    const double first = turn_deg * M_PI / 180.0;
    const double angle = angle_deg * M_PI / 180.0;
    const double dx = x - column;
    const double dy = y - row;
    const double v = (-dx * std::sin(first) + dy * std::cos(first)) / std::sin(angle);
    const double u = dx * std::cos(first) + dy * std::sin(first) - v * std::cos(angle);
    const auto on_line = [&](double at, double pitch) {
      return inside((0.5 * line_px - std::abs(at - pitch * std::round(at / pitch))) * std::sin(angle));
    };
    const double off = (1.0 - on_line(u, pitch_x_px)) * (1.0 - on_line(v, pitch_y_px));
    return 50.0 + slope_x * x + slope_y * y + (1.0 - off) * height_um;
  }
};

CrossGridPlaces found(const HeightField& field) {
  const auto outcome = grid_crossings(field);
  if (const auto* refusal = std::get_if<StudyRefusal>(&outcome)) ADD_FAILURE() << refusal->text;
  return std::holds_alternative<CrossGridPlaces>(outcome) ? std::get<CrossGridPlaces>(outcome) : CrossGridPlaces{};
}

struct Errors {
  double worst_px = 0.0;
  double mean_x_px = 0.0;
  double mean_y_px = 0.0;
};

Errors errors(const CrossGridPlaces& places, const Grid& grid) {
  Errors result;
  for (const GridCrossing& crossing : places.crossings) {
    const auto [column, row] = grid.place(crossing.index_x, crossing.index_y);
    result.worst_px = std::max(result.worst_px, std::hypot(crossing.column - column, crossing.row - row));
    result.mean_x_px += (crossing.column - column) / static_cast<double>(places.crossings.size());
    result.mean_y_px += (crossing.row - row) / static_cast<double>(places.crossings.size());
  }
  return result;
}

/// The relative errors of the pitches, of a grid of right angles and pixels of 1 um.
double lateral_error(const CrossGridPlaces& places, double pitch_um) {
  const auto grid = std::get<LateralGrid>(lateral_grid(places.crossings, pitch_um));
  return std::max(std::abs(grid.pitch_x_um - 1.0), std::abs(grid.pitch_y_um - 1.0));
}

bool refused(const HeightField& field, const Region& region = {}) {
  return std::holds_alternative<StudyRefusal>(grid_crossings(field, region));
}

TEST(GridCrossings, AreWhereTheMiddlesOfLinesMeet) {
  const Grid grid{.column = 233.2, .row = 181.6};

  const CrossGridPlaces places = found(seen(kWidth, kHeight, grid));

  EXPECT_EQ(places.crossings.size(), 35U);
  EXPECT_EQ(places.expected, 35);
  EXPECT_TRUE(places.raised);
  EXPECT_NEAR(places.line_height_um, 20.0, 0.05);
  EXPECT_NEAR(places.line_width_x_px, 24.0, 0.3);
  EXPECT_LT(errors(places, grid).worst_px, 0.02);
}

TEST(GridCrossings, GiveThePitchToTwoTenThousandths) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const double shift = 0.17 * static_cast<double>(seed);
    const Grid grid{.turn_deg = 1.3 * static_cast<double>(seed - 1), .column = 239.5 + shift, .row = 179.5 - shift};
    HeightField field = seen(kWidth, kHeight, grid);
    add_noise(field, 0.22, seed);

    const CrossGridPlaces places = found(field);

    EXPECT_LT(lateral_error(places, 60.0), 2e-4);
    EXPECT_LT(std::abs(errors(places, grid).mean_x_px), 0.02);
    EXPECT_LT(std::abs(errors(places, grid).mean_y_px), 0.02);
    RecordProperty("lateral_error_e6_" + std::to_string(seed), static_cast<int>(1e6 * lateral_error(places, 60.0)));
  }
}

TEST(GridCrossings, AreFoundTurned) {
  for (const double turn : {-44.0, -10.0, 0.5, 20.0, 43.0}) {
    Grid grid{.pitch_x_px = 50.0, .pitch_y_px = 56.0, .line_px = 20.0, .turn_deg = turn};
    grid.slope_x = 0.05;
    grid.slope_y = -0.03;
    HeightField field = seen(kWidth, kHeight, grid);
    add_noise(field, 0.22, 7);

    const CrossGridPlaces places = found(field);

    EXPECT_GE(places.crossings.size(), 35U) << turn;
    EXPECT_GE(static_cast<int>(places.crossings.size()), places.expected - 2) << turn;
    EXPECT_LT(errors(places, grid).worst_px, 0.15) << turn;
    EXPECT_LT(std::abs(errors(places, grid).mean_x_px), 0.02) << turn;
    EXPECT_LT(std::abs(errors(places, grid).mean_y_px), 0.02) << turn;
  }
}

TEST(GridCrossings, AreFoundOfSunkLinesAndOfAxesThatAreNotSquare) {
  const Grid grid{.pitch_x_px = 40.0, .pitch_y_px = 64.0, .line_px = 16.0, .height_um = -12.0, .angle_deg = 78.0};
  HeightField field = seen(kWidth, kHeight, grid);
  add_noise(field, 0.2, 3);

  const CrossGridPlaces places = found(field);

  EXPECT_FALSE(places.raised);
  EXPECT_NEAR(places.line_height_um, 12.0, 0.1);
  EXPECT_LT(errors(places, grid).worst_px, 0.15);
  EXPECT_GE(static_cast<int>(places.crossings.size()), places.expected - 1);
}

TEST(GridCrossings, AreFoundBesideHolesAndWhereSomeAreMissing) {
  const Grid grid{.turn_deg = 8.0, .slope_x = 0.02};
  HeightField field = seen(kWidth, kHeight, grid);
  add_noise(field, 0.22, 5);
  add_holes(field, 0.3, 6);
  make_hole(field, 200, 290, 150, 240);  // around the crossing in the middle
  for (int y = 20; y < 90; ++y) {
    for (int x = 60; x < 120; ++x) field.z_um.at(x, y) = 53.0;  // dirt
  }

  const CrossGridPlaces places = found(field);

  EXPECT_GE(places.crossings.size(), 25U);
  EXPECT_LT(static_cast<int>(places.crossings.size()), places.expected);
  EXPECT_LT(errors(places, grid).worst_px, 0.15);
  EXPECT_LT(lateral_error(places, 60.0), 2e-4);
  for (const GridCrossing& crossing : places.crossings) EXPECT_FALSE(crossing.index_x == 0 && crossing.index_y == 0);
}

TEST(GridCrossings, AreFoundOfLinesNotMuchWiderThanTheWindow) {
  const Grid grid{.pitch_x_px = 40.0, .pitch_y_px = 40.0, .line_px = 12.0, .turn_deg = 3.0};
  HeightField field = seen(kWidth, kHeight, grid);
  add_noise(field, 0.2, 3);

  const CrossGridPlaces places = found(field);

  EXPECT_GE(places.crossings.size(), 80U);
  EXPECT_LT(lateral_error(places, 40.0), 2e-4);
}

TEST(GridCrossings, MirrorTheirPlacesWithTheField) {
  const Grid grid{.turn_deg = 6.0, .angle_deg = 86.0, .column = 237.3, .row = 181.2};
  HeightField field = seen(kWidth, kHeight, grid);
  add_noise(field, 0.22, 4);

  const CrossGridPlaces places = found(field);
  const CrossGridPlaces other = found(mirrored(field));

  ASSERT_EQ(other.crossings.size(), places.crossings.size());
  for (const GridCrossing& crossing : places.crossings) {
    const auto same = std::find_if(other.crossings.begin(), other.crossings.end(), [&](const GridCrossing& there) {
      return there.index_x == -crossing.index_x && there.index_y == crossing.index_y;
    });
    ASSERT_NE(same, other.crossings.end());
    EXPECT_NEAR(kWidth - 1 - same->column, crossing.column, 5e-3);
    EXPECT_NEAR(same->row, crossing.row, 5e-3);
  }
}

TEST(GridCrossings, AreNumberedFromThePlaceThatIsGiven) {
  const Grid grid{};
  const HeightField field = seen(kWidth, kHeight, grid);
  const auto number_at = [&](const GridSearch& search, double column, double row) {
    const auto places = std::get<CrossGridPlaces>(grid_crossings(field, {}, search));
    for (const GridCrossing& crossing : places.crossings) {
      if (std::hypot(crossing.column - column, crossing.row - row) < 1.0) {
        return std::pair(crossing.index_x, crossing.index_y);
      }
    }
    return std::pair(99, 99);
  };

  EXPECT_EQ(number_at({}, 239.5, 179.5), std::pair(0, 0));
  EXPECT_EQ(number_at({}, 299.5, 119.5), std::pair(1, -1));
  EXPECT_EQ(number_at({ImagePlace{295.0, 130.0}}, 299.5, 119.5), std::pair(0, 0));
  EXPECT_EQ(number_at({ImagePlace{295.0, 130.0}}, 239.5, 179.5), std::pair(-1, 1));
}

TEST(GridCrossings, LookAtTheRegionAlone) {
  const Grid grid{};
  const HeightField field = seen(kWidth, kHeight, grid);
  Region region(kWidth, kHeight, 0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < 300; ++x) region.at(x, y) = 1;
  }

  const auto places = std::get<CrossGridPlaces>(grid_crossings(field, region));

  EXPECT_EQ(places.crossings.size(), 20U);
  EXPECT_LT(errors(places, grid).worst_px, 0.02);
}

TEST(GridCrossings, AreRefusedWhereThereIsNoGrid) {
  HeightField flat = seen(kWidth, kHeight, [](double x, double) { return 0.01 * x; });
  add_noise(flat, 0.2, 1);
  HeightField grooves =
      seen(kWidth, kHeight, [](double x, double) { return std::fmod(x + 60.0, 60.0) < 24.0 ? 20.0 : 0.0; });
  add_noise(grooves, 0.2, 1);
  HeightField step = seen(kWidth, kHeight, [](double x, double) { return x < 200.0 ? 20.0 : 0.0; });
  add_noise(step, 0.2, 1);
  HeightField star = seen(kWidth, kHeight, [](double x, double y) {
    return std::hypot(x - 240.0, y - 180.0) < 170.0 && std::cos(18.0 * std::atan2(y - 180.0, x - 240.0)) > 0.0 ? 20.0
                                                                                                               : 0.0;
  });
  add_noise(star, 0.2, 1);
  HeightField checkers = seen(kWidth, kHeight, [](double x, double y) {
    return std::sin(M_PI * x / 30.0) * std::sin(M_PI * y / 30.0) > 0.0 ? 20.0 : 0.0;
  });
  add_noise(checkers, 0.2, 1);
  HeightField waves = seen(
      kWidth, kHeight, [](double x, double y) { return 5.0 * std::sin(M_PI * x / 30.0) * std::sin(M_PI * y / 30.0); });
  HeightField holes(flat.clone());
  add_holes(holes, 1.1, 1);

  EXPECT_TRUE(refused(flat));
  EXPECT_TRUE(refused(grooves));
  EXPECT_TRUE(refused(step));
  EXPECT_TRUE(refused(star));
  EXPECT_TRUE(refused(checkers));
  EXPECT_TRUE(refused(waves));
  EXPECT_TRUE(refused(holes));
}

TEST(GridCrossings, AreRefusedWhereTooFewAreSeen) {
  const Grid grid{};
  const HeightField field = seen(140, 140, Grid{.column = 40.0, .row = 40.0});

  EXPECT_TRUE(refused(field));
  EXPECT_TRUE(refused(seen(kWidth, kHeight, grid), Region(kWidth, kHeight, 0)));
}

}  // namespace
}  // namespace fvd::metrology
