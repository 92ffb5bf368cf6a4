#include "core/metrology/artefact/edge_response.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/core/metrology/artefact/artefact_fields.hpp"

namespace fvd::metrology {
namespace {

using testing::add_holes;
using testing::add_noise;
using testing::inside;
using testing::kBox_px;
using testing::mirrored;
using testing::seen;

/// A step up along a direction, through the middle of 200 x 160 pixels.
struct Step {
  double across_deg = 0.0;
  double height_um = 20.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  double column = 99.5;

  [[nodiscard]] double operator()(double x, double y) const {
    const double across = across_deg * M_PI / 180.0;
    const double out = (x - column) * std::cos(across) + (y - 79.5) * std::sin(across);
    return 50.0 + slope_x * x + slope_y * y + height_um * inside(out);
  }
};

HeightField edge(const Step& step) { return seen(200, 160, step); }

EdgeResponse found(const HeightField& field, const Region& region = {}) {
  const auto outcome = edge_response(field, region);
  if (const auto* refusal = std::get_if<StudyRefusal>(&outcome)) ADD_FAILURE() << refusal->text;
  return std::holds_alternative<EdgeResponse>(outcome) ? std::get<EdgeResponse>(outcome) : EdgeResponse{};
}

bool refused(const HeightField& field, const Region& region = {}) {
  return std::holds_alternative<StudyRefusal>(edge_response(field, region));
}

/// Period at which a square box halves a wave across the direction.
double box_limit(double across_deg) {
  const auto sinc = [](double x) { return std::abs(x) < 1e-12 ? 1.0 : std::sin(M_PI * x) / (M_PI * x); };
  const double across = across_deg * M_PI / 180.0;
  double low = 8.0;
  double high = 24.0;
  for (int round = 0; round < 50; ++round) {
    const double middle = 0.5 * (low + high);
    const double half = sinc(kBox_px * std::cos(across) / middle) * sinc(kBox_px * std::sin(across) / middle);
    (half < 0.5 ? low : high) = middle;
  }
  return low;
}

TEST(EdgeResponse, ReadsTheLimitsOfABox) {
  for (const double shift : {0.0, 0.3, 0.5}) {
    const EdgeResponse response = found(edge({.column = 99.5 + shift}));

    EXPECT_NEAR(response.across_deg, 0.0, 1e-6);
    EXPECT_NEAR(response.edge_deg, 90.0, 1e-6);
    EXPECT_NEAR(response.height_um, 20.0, 0.01);
    EXPECT_NEAR(response.width_10_90_um, 0.8 * kBox_px, 0.1) << shift;
    ASSERT_TRUE(response.period_um);
    EXPECT_NEAR(*response.period_um / box_limit(0.0), 1.0, 0.015) << shift;  // whole pixels sample it
    EXPECT_LT(response.straightness_px, 0.05);
  }
  EXPECT_NEAR(box_limit(0.0), 1.657 * kBox_px, 0.01);
}

TEST(EdgeResponse, ReadsThemAcrossEveryDirection) {
  for (const double across : {3.0, 20.0, 45.0, 77.0, 90.0, 110.0, 135.0, 160.0, 200.0, 300.0}) {
    HeightField field = edge({.across_deg = across, .slope_x = 0.02, .slope_y = -0.01});
    add_noise(field, 0.22, 3);

    const EdgeResponse response = found(field);

    EXPECT_NEAR(std::remainder(response.across_deg - across, 180.0), 0.0, 0.3) << across;
    EXPECT_NEAR(std::remainder(response.edge_deg - across - 90.0, 180.0), 0.0, 0.3) << across;
    ASSERT_TRUE(response.period_um) << across;
    EXPECT_NEAR(*response.period_um / box_limit(across), 1.0, 0.02) << across;
    EXPECT_NEAR(response.height_um, 20.0, 0.2) << across;
  }
}

TEST(EdgeResponse, ReadsThemBesideHolesAndInAMirror) {
  HeightField field = edge({.across_deg = 12.0, .height_um = -8.0});
  add_noise(field, 0.1, 3);
  add_holes(field, 0.3, 4);

  const EdgeResponse response = found(field);
  const EdgeResponse other = found(mirrored(field));

  EXPECT_NEAR(response.height_um, 8.0, 0.1);
  EXPECT_NEAR(*response.period_um / box_limit(12.0), 1.0, 0.02);
  EXPECT_NEAR(*other.period_um, *response.period_um, 0.02);
  EXPECT_NEAR(other.width_10_90_um, response.width_10_90_um, 0.02);
  EXPECT_NEAR(other.across_deg, 180.0 - response.across_deg, 1e-3);
}

TEST(EdgeResponse, HasUnitsOfThePitch) {
  HeightField field = edge({.across_deg = 10.0});
  const EdgeResponse pixels = found(field);
  field.pitch_x_um = 0.5;
  field.pitch_y_um = 0.5;

  const EdgeResponse response = found(field);

  EXPECT_NEAR(*response.period_um, 0.5 * *pixels.period_um, 1e-6);
  EXPECT_NEAR(response.width_10_90_um, 0.5 * pixels.width_10_90_um, 1e-6);
}

TEST(EdgeResponse, SaysWhereItIsResolvedAsFarAsPixelsTell) {
  HeightField field{Plane<double>(200, 160), {}, 1.0, 1.0, {}};
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) field.z_um.at(x, y) = x < 100 ? 0.0 : 20.0;
  }

  const EdgeResponse response = found(field);

  EXPECT_FALSE(response.period_um);
  EXPECT_FALSE(response.reason.empty());
  EXPECT_NEAR(response.width_10_90_um, 0.8, 0.05);
}

TEST(EdgeResponse, LooksAtTheRegionAlone) {
  HeightField field = seen(200, 160, [](double x, double) { return 20.0 * inside(x - 60.0) * inside(140.0 - x); });
  Region region(200, 160, 0);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 100; ++x) region.at(x, y) = 1;
  }

  EXPECT_NEAR(*found(field, region).period_um / box_limit(0.0), 1.0, 0.015);
  EXPECT_TRUE(refused(field));
}

TEST(EdgeResponse, IsRefusedWhereThereIsNoStraightEdge) {
  HeightField flat = seen(200, 160, [](double x, double) { return 0.01 * x; });
  add_noise(flat, 0.2, 1);
  const HeightField disc =
      seen(200, 160, [](double x, double y) { return 20.0 * inside(60.0 - std::hypot(x - 100.0, y - 80.0)); });
  const HeightField bent =
      seen(200, 160, [](double x, double y) { return 20.0 * inside(x - 80.0 - 0.004 * (y - 80.0) * (y - 80.0)); });
  HeightField holes = edge({});
  for (int y = 0; y < 160; ++y) {
    for (int x = 95; x < 105; ++x) holes.z_um.at(x, y) = std::numeric_limits<double>::quiet_NaN();
  }

  EXPECT_TRUE(refused(flat));
  EXPECT_TRUE(refused(disc));
  EXPECT_TRUE(refused(bent));
  EXPECT_TRUE(refused(holes));
  EXPECT_TRUE(refused(edge({}), Region(200, 160, 0)));
}

}  // namespace
}  // namespace fvd::metrology
