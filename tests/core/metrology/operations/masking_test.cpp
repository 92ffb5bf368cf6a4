#include "core/metrology/operations/masking.hpp"

#include <gtest/gtest.h>

#include "tests/core/metrology/operations/operation_fields.hpp"

namespace fvd::metrology {
namespace {

HeightField row_with_sigma() {
  HeightField field = make_field(4, 1, 1.0, 1.0, [](double x, double) { return x; });
  field.sigma_um = Plane<float>(4, 1);
  for (int column = 0; column < 4; ++column) field.sigma_um.at(column, 0) = 0.5F * static_cast<float>(column);
  return field;
}

TEST(MaskSigma, RemovesOnlyWhatIsAboveTheLimit) {
  HeightField field = row_with_sigma();
  Plane<MaskReasons> reasons(4, 1);

  const OperationReport report = mask_sigma(field, 1.0, &reasons);

  EXPECT_FALSE(report.refused);
  EXPECT_EQ(report.points_removed, 1U);
  EXPECT_FALSE(field.is_hole(2, 0));
  EXPECT_TRUE(field.is_hole(3, 0));
  EXPECT_TRUE(std::isnan(field.sigma_um.at(3, 0)));
  EXPECT_EQ(reasons.at(3, 0), mask_reason::kMaxSigma);
  EXPECT_EQ(reasons.at(2, 0), 0);
}

TEST(MaskSigma, IsRefusedWithoutStandardErrors) {
  HeightField field = make_field(2, 1, 1.0, 1.0, [](double x, double) { return x; });

  EXPECT_TRUE(mask_sigma(field, 1.0).refused);
  EXPECT_EQ(hole_count(field), 0U);
}

TEST(MaskReasons, RemovesPointsThatCarryOneOfTheBits) {
  HeightField field = row_with_sigma();
  Plane<MaskReasons> reasons(4, 1);
  reasons.at(0, 0) = mask_reason::kEdgeBand;
  reasons.at(1, 0) = mask_reason::kEdgeBand | mask_reason::kSaturated;
  reasons.at(2, 0) = mask_reason::kNarrowCurve;

  const OperationReport report = mask_reasons(field, reasons, mask_reason::kSaturated | mask_reason::kNarrowCurve);

  EXPECT_EQ(report.points_removed, 2U);
  EXPECT_FALSE(field.is_hole(0, 0));
  EXPECT_TRUE(field.is_hole(1, 0));
  EXPECT_TRUE(field.is_hole(2, 0));
  EXPECT_TRUE(mask_reasons(field, Plane<MaskReasons>(3, 1), 1).refused);
}

}  // namespace
}  // namespace fvd::metrology
