#include "core/metrology/artefact/siemens_star.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/core/metrology/artefact/artefact_fields.hpp"

namespace fvd::metrology {
namespace {

using testing::add_holes;
using testing::add_noise;
using testing::inside;
using testing::kBox_px;
using testing::make_hole;
using testing::mirrored;
using testing::seen;

constexpr int kWidth = 480;
constexpr int kHeight = 360;

struct Star {
  int pairs = 18;
  double radius_px = 170.0;
  double height_um = 20.0;
  double turn_deg = 0.0;
  double column = 239.5;
  double row = 179.5;
  double slope_x = 0.0;

  [[nodiscard]] double operator()(double x, double y) const {
    const double radius = std::hypot(x - column, y - row);
    const double phase = pairs * (std::atan2(y - row, x - column) - turn_deg * M_PI / 180.0);
    // Distance to the nearest edge between sectors, along the circle.
    const double off = radius / pairs * (0.5 * M_PI - std::abs(std::remainder(phase, 2.0 * M_PI)));
    return 50.0 + slope_x * x + height_um * inside(off) * inside(radius_px - radius);
  }
};

StarResolution found(const HeightField& field, const StarSettings& settings = {}) {
  const auto outcome = siemens_star(field, settings);
  if (const auto* refusal = std::get_if<StudyRefusal>(&outcome)) ADD_FAILURE() << refusal->text;
  return std::holds_alternative<StarResolution>(outcome) ? std::get<StarResolution>(outcome) : StarResolution{};
}

bool refused(const HeightField& field, const StarSettings& settings = {}, const Region& region = {}) {
  return std::holds_alternative<StudyRefusal>(siemens_star(field, settings, region));
}

/// Transfer of a square box to a wave of the period, across the direction.
double box_transfer(double period_px, double across_deg) {
  const auto sinc = [](double x) { return std::abs(x) < 1e-12 ? 1.0 : std::sin(M_PI * x) / (M_PI * x); };
  const double across = across_deg * M_PI / 180.0;
  return sinc(kBox_px * std::cos(across) / period_px) * sinc(kBox_px * std::sin(across) / period_px);
}
double box_limit(double across_deg) {
  double low = 10.0;
  double high = 20.0;
  for (int round = 0; round < 50; ++round) {
    const double middle = 0.5 * (low + high);
    (box_transfer(middle, across_deg) < 0.5 ? low : high) = middle;
  }
  return low;
}

TEST(SiemensStar, ReadsTheLimitsOfABox) {
  const Star star{.column = 233.7, .row = 186.2};

  const StarResolution result = found(seen(kWidth, kHeight, star));

  EXPECT_EQ(result.pairs, 18);
  EXPECT_NEAR(result.centre.x, 234.2, 0.02);
  EXPECT_NEAR(result.centre.y, 186.7, 0.02);
  EXPECT_NEAR(result.radius_um, 170.0, 3.0);
  EXPECT_NEAR(result.height_um, 20.0, 0.05);
  EXPECT_FALSE(result.height_given);
  ASSERT_EQ(result.directions.size(), 8U);
  for (const StarDirection& direction : result.directions) {
    ASSERT_TRUE(direction.width_um && direction.period_um) << direction.reason;
    EXPECT_NEAR(*direction.period_um / box_limit(direction.across_deg), 1.0, 0.02) << direction.azimuth_deg;
  }
  // Along its sides a box lets half of the height through where a sector is three quarters of it wide.
  EXPECT_NEAR(*result.directions[0].width_um, 0.75 * kBox_px, 0.15);
  EXPECT_NEAR(*result.directions[2].width_um, 0.75 * kBox_px, 0.15);
  EXPECT_NEAR(box_limit(0.0), 1.657 * kBox_px, 0.01);
}

TEST(SiemensStar, ReadsThemThroughNoiseTiltAndHoles) {
  const Star star{.turn_deg = 4.0, .column = 245.1, .row = 170.4, .slope_x = 0.02};
  HeightField field = seen(kWidth, kHeight, star);
  const StarResolution clean = found(field);
  add_noise(field, 0.22, 3);
  add_holes(field, 0.2, 4);

  const StarResolution result = found(field);

  EXPECT_NEAR(result.centre.x, clean.centre.x, 0.05);
  EXPECT_NEAR(result.centre.y, clean.centre.y, 0.05);
  EXPECT_NEAR(result.width_um / clean.width_um, 1.0, 0.02);
  EXPECT_NEAR(result.period_um / clean.period_um, 1.0, 0.01);
}

TEST(SiemensStar, TellsDirectionsApart) {
  // A box twice as wide along x blurs what follows along x, at azimuths near 90 and 270 degrees.
  const Star star{.pairs = 8};
  const HeightField field = seen(kWidth, kHeight, [&](double x, double y) {
    return 0.5 * star(x - 0.5 * kBox_px, y) + 0.5 * star(x + 0.5 * kBox_px, y);
  });

  const StarResolution result = found(field, {.height_um = 20.0});

  EXPECT_EQ(result.directions[2].azimuth_deg, 90.0);
  EXPECT_EQ(result.directions[2].across_deg, 0.0);
  EXPECT_EQ(result.directions[0].across_deg, 90.0);
  EXPECT_GT(*result.directions[2].period_um, 1.6 * *result.directions[0].period_um);
  EXPECT_NEAR(*result.directions[6].period_um / *result.directions[2].period_um, 1.0, 0.02);
  EXPECT_NEAR(*result.directions[0].period_um / (1.657 * kBox_px), 1.0, 0.15);
}

TEST(SiemensStar, HasUnitsOfThePitch) {
  HeightField field = seen(kWidth, kHeight, Star{});
  const StarResolution pixels = found(field);
  field.pitch_x_um = 0.5;
  field.pitch_y_um = 0.5;

  const StarResolution result = found(field);

  EXPECT_NEAR(result.width_um, 0.5 * pixels.width_um, 1e-6);
  EXPECT_NEAR(result.period_um, 0.5 * pixels.period_um, 1e-6);
  EXPECT_NEAR(result.centre.x, 120.0, 0.01);
}

TEST(SiemensStar, UsesWhatIsGiven) {
  const HeightField field = seen(kWidth, kHeight, Star{});
  const StarResolution own = found(field);

  const StarResolution result = found(field, {.pairs = 18, .centre = PointUm{240.0, 180.0}, .height_um = 25.0});

  EXPECT_EQ(result.centre.x, 240.0);
  EXPECT_TRUE(result.height_given);
  EXPECT_EQ(result.height_um, 25.0);
  EXPECT_GT(result.width_um, 1.05 * own.width_um);  // 12.5 of 20 um are reached farther outwards
}

TEST(SiemensStar, MirrorsItsDirectionsWithTheField) {
  HeightField field = seen(kWidth, kHeight, Star{.pairs = 20, .turn_deg = 3.0, .column = 230.0});
  add_noise(field, 0.2, 2);

  const StarResolution result = found(field);
  const StarResolution other = found(mirrored(field));

  EXPECT_NEAR(kWidth - other.centre.x, result.centre.x, 1e-3);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(*other.directions[(12 - i) % 8].period_um, *result.directions[i].period_um, 0.05);
  }
}

TEST(SiemensStar, SaysWhyADirectionHasNoValue) {
  HeightField field = seen(kWidth, kHeight, Star{});
  make_hole(field, 240, 480, 165, 195);
  make_hole(field, 240, 300, 140, 220);

  const StarResolution result = found(field);

  EXPECT_FALSE(result.directions[0].width_um);
  EXPECT_FALSE(result.directions[0].reason.empty());
  EXPECT_TRUE(result.directions[4].width_um);
  EXPECT_TRUE(result.directions[4].reason.empty());
}

TEST(SiemensStar, IsRefusedWhereThereIsNone) {
  HeightField flat = seen(kWidth, kHeight, [](double x, double) { return 0.01 * x; });
  add_noise(flat, 0.2, 1);
  const HeightField step = seen(kWidth, kHeight, [](double x, double) { return x < 200.0 ? 20.0 : 0.0; });
  const HeightField grid = seen(kWidth, kHeight, [](double x, double y) {
    return std::fmod(x + 60.0, 60.0) < 24.0 || std::fmod(y + 60.0, 60.0) < 24.0 ? 20.0 : 0.0;
  });
  const HeightField star = seen(kWidth, kHeight, Star{});

  EXPECT_TRUE(refused(flat));
  EXPECT_TRUE(refused(step));
  EXPECT_TRUE(refused(grid));
  EXPECT_TRUE(refused(star, {.directions = 24}));
  EXPECT_TRUE(refused(star, {}, Region(kWidth, kHeight, 0)));
  EXPECT_TRUE(refused(seen(kWidth, kHeight, Star{.radius_px = 60.0})));  // its rim is hardly resolved
}

TEST(SiemensStar, NeedsSettingsInTheirRange) {
  const HeightField field{Plane<double>(50, 50), {}, 1.0, 1.0, {}};
  for (const StarSettings& settings :
       {StarSettings{.pairs = 3}, StarSettings{.pairs = 181}, StarSettings{.height_um = 0.0},
        StarSettings{.centre = PointUm{NAN, 0.0}}, StarSettings{.centre = PointUm{1e12, 0.0}},
        StarSettings{.directions = 3}, StarSettings{.directions = 37}}) {
    EXPECT_THROW(static_cast<void>(siemens_star(field, settings)), Error);
  }
}

}  // namespace
}  // namespace fvd::metrology
