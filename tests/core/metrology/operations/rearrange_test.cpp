#include "core/metrology/operations/rearrange.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/operations/lateral.hpp"
#include "tests/core/metrology/operations/operation_fields.hpp"

namespace fvd::metrology {
namespace {

HeightField numbered(int width, int height) {
  HeightField field = make_field(width, height, 1.0, 1.0, [](double x, double y) { return x + 100.0 * y; });
  field.sigma_um = Plane<float>(width, height, 0.3F);
  return field;
}

TEST(Crop, KeepsThePixelsWhoseCentresLieInTheRectangle) {
  HeightField field = numbered(6, 5);
  Plane<MaskReasons> reasons(6, 5);
  reasons.at(2, 3) = 8;

  const OperationReport report = crop(field, {1.5, 2.6, 2.0, 10.0}, &reasons);

  EXPECT_EQ(field.width(), 3);
  EXPECT_EQ(field.height(), 2);
  EXPECT_EQ(field.z_um.at(0, 0), 1.5 + 350.0);
  EXPECT_EQ(field.sigma_um.width(), 3);
  EXPECT_EQ(reasons.at(1, 0), 8);
  EXPECT_EQ(value(report, "first_column"), 1.0);
  EXPECT_EQ(value(report, "first_row"), 3.0);
  EXPECT_TRUE(crop(field, {100.0, 0.0, 5.0, 5.0}).refused);
}

TEST(ShiftAndInvert, ChangeHeightsAndKeepHoles) {
  HeightField field = make_field(2, 1, 1.0, 1.0, [](double x, double) { return x > 1.0 ? kHole : 3.0; });

  EXPECT_EQ(value(shift_z(field, 2.0), "shift_um"), 2.0);
  EXPECT_FALSE(invert(field).refused);

  EXPECT_EQ(field.z_um.at(0, 0), -5.0);
  EXPECT_TRUE(field.is_hole(1, 0));
}

TEST(FlatnessReference, IsSubtractedWithItsStandardErrorAndItsHoles) {
  HeightField field = numbered(3, 2);
  HeightField reference = make_field(3, 2, 1.0, 1.0, [](double x, double) { return x > 2.0 ? kHole : 0.25; });
  reference.sigma_um = Plane<float>(3, 2, 0.4F);
  Plane<MaskReasons> reasons(3, 2);

  const OperationReport report = flatness_reference(field, reference, &reasons);

  EXPECT_EQ(field.z_um.at(1, 1), 1.5 + 150.0 - 0.25);
  EXPECT_FLOAT_EQ(field.sigma_um.at(1, 1), 0.5F);
  EXPECT_TRUE(field.is_hole(2, 0));
  EXPECT_TRUE(std::isnan(field.sigma_um.at(2, 0)));
  EXPECT_NE(reasons.at(2, 0), 0);
  EXPECT_EQ(report.points_removed, 2U);
  EXPECT_TRUE(report.warnings.empty());
}

TEST(FlatnessReference, IsRefusedOnAnotherGridAndWarnsWithoutStandardErrors) {
  HeightField field = numbered(3, 2);
  HeightField reference = make_field(3, 2, 1.0, 1.00001, [](double, double) { return 0.0; });

  EXPECT_TRUE(flatness_reference(field, numbered(3, 3)).refused);
  EXPECT_TRUE(flatness_reference(field, reference).refused);
  reference.pitch_y_um = 1.0 + 1e-8;
  EXPECT_EQ(flatness_reference(field, reference).warnings.size(), 1U);
}

TEST(Lateral, SetsThePitchAndLeavesASmallShear) {
  HeightField field = numbered(10, 200);
  const HeightField before = field.clone();

  const OperationReport report = lateral(field, {0.5, 0.25, -1e-4});

  EXPECT_EQ(field.pitch_x_um, 0.5);
  EXPECT_EQ(field.pitch_y_um, 0.25);
  EXPECT_EQ(worst_difference(field.z_um, before.z_um), 0.0);
  EXPECT_EQ(value(report, "resampled"), 0.0);
  EXPECT_NEAR(value(report, "shift_left_um"), 1e-4 * 50.0, 1e-15);
}

TEST(Lateral, PutsAShearedSurfaceUpright) {
  // A straight surface z = 2 x + 3 y, seen on sheared points.
  for (const double shear : {0.02, -0.03}) {
    HeightField field =
        make_field(50, 40, 0.5, 0.25, [shear](double x, double y) { return 2.0 * (x + shear * y) + 3.0 * y; });
    field.sigma_um = Plane<float>(50, 40, 0.1F);

    const OperationReport report = lateral(field, {0.5, 0.25, shear});

    EXPECT_EQ(value(report, "resampled"), 1.0);
    for (int row = 0; row < 40; ++row) {
      for (int column = 0; column < 50; ++column) {
        if (field.is_hole(column, row)) continue;
        EXPECT_NEAR(field.z_um.at(column, row), 2.0 * field.x_um(column) + 3.0 * field.y_um(row), 1e-12);
        EXPECT_NEAR(field.sigma_um.at(column, row), 0.1F, 1e-7F);
      }
    }
    EXPECT_EQ(hole_count(field), report.points_removed);
    EXPECT_TRUE(field.is_hole(shear > 0.0 ? 0 : 49, 39));
    EXPECT_FALSE(field.is_hole(25, 39));
  }
}

TEST(Lateral, MakesAHoleOfAPointWithAMissingNeighbour) {
  // The second row is shifted by exactly one pixel, the first by a third of one.
  HeightField field = make_field(6, 2, 1.0, 20.0, [](double x, double) { return x; });
  field.z_um.at(3, 0) = kHole;
  field.z_um.at(3, 1) = kHole;
  Plane<MaskReasons> reasons(6, 2);
  reasons.at(3, 0) = 4;
  reasons.at(3, 1) = 4;

  (void)lateral(field, {1.0, 20.0, -1.0 / 30.0}, &reasons);

  EXPECT_NEAR(field.z_um.at(0, 0), 0.5 + 1.0 / 3.0, 1e-12);
  EXPECT_TRUE(field.is_hole(2, 0));
  EXPECT_TRUE(field.is_hole(3, 0));
  EXPECT_FALSE(field.is_hole(4, 0));
  EXPECT_EQ(reasons.at(2, 0), 4);
  EXPECT_EQ(reasons.at(5, 0), mask_reason::kOutOfView);
  EXPECT_FALSE(field.is_hole(1, 1));
  EXPECT_TRUE(field.is_hole(2, 1));
  EXPECT_EQ(reasons.at(3, 1), 0);
  EXPECT_EQ(field.z_um.at(3, 1), 4.5);
  EXPECT_TRUE(field.is_hole(5, 1));
}

TEST(Lateral, AsksForNoNeighbourWhereRoundingMissesAWholePixel) {
  for (const double y_um : {7.0, 13.0}) {  // 6 / 70 * 7 / 0.1 is a little below 6, 6 / 130 * 13 / 0.1 above
    for (int pixels = 1; pixels <= 6; ++pixels) {
      HeightField field = make_field(20, 1, 0.1, 2.0 * y_um, [](double x, double) { return x; });
      field.z_um.at(12, 0) = kHole;

      (void)lateral(field, {0.1, 2.0 * y_um, -pixels / (10.0 * y_um)});

      EXPECT_EQ(hole_count(field), static_cast<std::size_t>(pixels) + 1U);
      EXPECT_TRUE(field.is_hole(12 - pixels, 0));
    }
  }
}

TEST(Lateral, RefusesCalibrationsThatCannotBe) {
  HeightField field = numbered(2, 2);

  EXPECT_THROW((void)lateral(field, {0.0, 1.0, 0.0}), Error);
  EXPECT_THROW((void)lateral(field, {1.0, -1.0, 0.0}), Error);
  EXPECT_THROW((void)lateral(field, {1.0, 1.0, 0.2}), Error);
}

}  // namespace
}  // namespace fvd::metrology
