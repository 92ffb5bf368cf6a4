#include "core/metrology/operations/form.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/operations/region.hpp"
#include "tests/core/metrology/operations/operation_fields.hpp"

namespace fvd::metrology {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;

/// Heights of the points p of a vertical line with distance(p) = 0, by bisection between two heights.
template <typename Distance>
double root(double low, double high, const Distance& distance) {
  auto a = static_cast<long double>(low);
  auto b = static_cast<long double>(high);
  const bool rises = distance(b) > 0.0L;
  for (int i = 0; i < 120; ++i) {
    const long double middle = 0.5L * (a + b);
    ((distance(middle) > 0.0L) == rises ? b : a) = middle;
  }
  return static_cast<double>(0.5L * (a + b));
}

HeightField sphere_cap(double side) {
  return make_field(160, 120, 0.8, 1.1, [side](double x, double y) {
    const long double dx = static_cast<long double>(x) - 70.0L;
    const long double dy = static_cast<long double>(y) - 60.0L;
    return static_cast<double>(12.0L + static_cast<long double>(side) * std::sqrt(500.0L * 500.0L - dx * dx - dy * dy));
  });
}

class SphereForm : public testing::TestWithParam<double> {};

TEST_P(SphereForm, FindsACapOfRadius500WithHoles) {
  HeightField field = sphere_cap(GetParam());
  punch_holes(field, 0.05, 1);
  const std::size_t holes = hole_count(field);

  const OperationReport report = remove_form(field, {FormKind::kSphere, 2}, {});

  ASSERT_FALSE(report.refused);
  EXPECT_NEAR(value(report, "radius_um"), 500.0, 1e-9);
  EXPECT_NEAR(value(report, "centre_x_um"), 70.0, 1e-9);
  EXPECT_NEAR(value(report, "centre_y_um"), 60.0, 1e-9);
  EXPECT_NEAR(value(report, "centre_z_um"), 12.0, 1e-9);
  EXPECT_EQ(value(report, "side"), GetParam());
  EXPECT_LT(largest(field), 1e-10);
  EXPECT_EQ(hole_count(field), holes);
  EXPECT_EQ(report.points_removed, 0U);
}

INSTANTIATE_TEST_SUITE_P(Sides, SphereForm, testing::Values(1.0, -1.0));

/// Sum of squared distances at right angles from the form that a report names, one of its values changed by `change`.
long double squared_distances(const HeightField& field, const OperationReport& report, const std::string& changed,
                              double change) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const auto get = [&](const char* name) {
    if (report.find(name) == nullptr) return 0.0L;
    return static_cast<long double>(value(report, name)) + (changed == name ? static_cast<long double>(change) : 0.0L);
  };
  const bool sphere = report.find("centre_x_um") != nullptr;
  const Vector centre = sphere ? Vector(get("centre_x_um"), get("centre_y_um"), get("centre_z_um"))
                               : Vector(get("axis_x_um"), get("axis_y_um"), get("axis_z_um"));
  const long double radian = std::numbers::pi_v<long double> / 180.0L;
  const long double azimuth = get("azimuth_deg") * radian;
  const long double elevation = get("elevation_deg") * radian;
  const long double taper = get("taper_deg") * radian;
  const Vector axis(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                    std::sin(elevation));
  long double sum = 0.0L;
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      if (field.is_hole(column, row)) continue;
      const Vector d = Vector(static_cast<long double>(field.x_um(column)), static_cast<long double>(field.y_um(row)),
                              static_cast<long double>(field.z_um.at(column, row))) -
                       centre;
      const long double along = sphere ? 0.0L : d.dot(axis);
      const long double off = std::sqrt(d.squaredNorm() - along * along);
      const long double distance = std::cos(taper) * (off - get("radius_um")) - std::sin(taper) * along;
      sum += distance * distance;
    }
  }
  return sum;
}

class RoundForm : public testing::TestWithParam<FormKind> {};

TEST_P(RoundForm, HasTheLeastSumOfSquaredDistances) {
  // Half of a tilted cone with noise, which none of the forms fits; it is steep at its sides.
  HeightField field = make_field(60, 70, 1.0, 1.0, [](double x, double y) {
    const double radius = 38.0 + 0.1 * x;
    return 0.05 * x + std::sqrt(radius * radius - (y - 35.0) * (y - 35.0));
  });
  add_noise(field, 0.5, 21);
  const HeightField before = field.clone();

  const OperationReport report = remove_form(field, {GetParam(), 2}, {});

  ASSERT_FALSE(report.refused);
  const long double least = squared_distances(before, report, "", 0.0);
  EXPECT_NEAR(value(report, "rms_um"), static_cast<double>(std::sqrt(least / 4200.0L)), 1e-10);
  int changed = 0;
  for (const NamedValue& named : report.values) {
    if (!named.standard_error || *named.standard_error == 0.0) continue;
    const double step = 0.01 * *named.standard_error;
    const long double more = squared_distances(before, report, named.name, step) - least;
    const long double less = squared_distances(before, report, named.name, -step) - least;
    if (more + less < 1e-10L * least / 4200.0L) continue;  // along the axis of a cylinder nothing changes
    EXPECT_LT(std::abs(0.5L * (less - more) / (more + less)), 1e-3L) << named.name;
    ++changed;
  }
  EXPECT_GE(changed, 4);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RoundForm, testing::Values(FormKind::kSphere, FormKind::kCylinder, FormKind::kCone));

TEST(SphereForm, PredictsTheScatterOfItsRadius) {
  double squares = 0.0;
  double predicted = 0.0;
  for (unsigned run = 0; run < 100; ++run) {
    HeightField field = make_field(40, 30, 2.0, 2.0, [](double x, double y) {
      return std::sqrt(250.0 * 250.0 - (x - 40.0) * (x - 40.0) - (y - 30.0) * (y - 30.0));
    });
    add_noise(field, 0.2, 200 + run);
    const OperationReport report = remove_form(field, {FormKind::kSphere, 2}, {});
    squares += std::pow(value(report, "radius_um") - 250.0, 2);
    predicted += std::pow(error_of(report, "radius_um"), 2);
  }

  EXPECT_NEAR(std::sqrt(squares / predicted), 1.0, 0.2);
}

TEST(SphereForm, MakesHolesBesideTheSphere) {
  HeightField field = make_field(100, 100, 1.0, 1.0, [](double x, double y) {
    const double square = (x - 50.0) * (x - 50.0) + (y - 50.0) * (y - 50.0);
    return square < 1600.0 ? std::sqrt(1600.0 - square) : 0.0;
  });
  Plane<MaskReasons> reasons(100, 100);

  const OperationReport report =
      remove_form(field, {FormKind::kSphere, 2}, circle_region(grid_of(field), {50.0, 50.0, 30.0}), &reasons);

  EXPECT_NEAR(value(report, "radius_um"), 40.0, 1e-9);
  EXPECT_NEAR(static_cast<double>(report.points_removed), 1e4 - std::numbers::pi * 1600.0, 50.0);
  EXPECT_EQ(reasons.at(1, 1), mask_reason::kOutlier);
  EXPECT_TRUE(field.is_hole(1, 1));
}

struct Axis {
  double azimuth_deg;
  double elevation_deg;
};

class AxisForm : public testing::TestWithParam<Axis> {
 protected:
  [[nodiscard]] Eigen::Vector3d direction() const {
    const double a = GetParam().azimuth_deg * kRadian;
    const double e = GetParam().elevation_deg * kRadian;
    return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
  }

  /// Upper side of a form around the axis through (60, 50, -20) whose radius grows from `radius` by `slope` along it.
  [[nodiscard]] HeightField field(double radius, double slope, double side) const {
    const Eigen::Matrix<long double, 3, 1> axis = direction().cast<long double>();
    return make_field(120, 100, 1.0, 1.0, [this, axis, radius, slope, side](double x, double y) {
      const auto distance = [&](long double z) {
        const Eigen::Matrix<long double, 3, 1> d(static_cast<long double>(x) - 60.0L,
                                                 static_cast<long double>(y) - 50.0L, z + 20.0L);
        const long double along = d.dot(axis);
        return (d - along * axis).norm() - (static_cast<long double>(radius) + static_cast<long double>(slope) * along);
      };
      // The point of the axis nearest to the vertical line lies inside of the form.
      const Eigen::Vector3d a = direction();
      const double s = ((x - 60.0) * a.x() + (y - 50.0) * a.y()) / (a.x() * a.x() + a.y() * a.y());
      const double inside = -20.0 + s * a.z();
      return root(inside, inside + side * 3.0 * radius, distance);
    });
  }
};

TEST_P(AxisForm, FindsACylinder) {
  for (const double side : {1.0, -1.0}) {
    HeightField cylinder = field(150.0, 0.0, side);
    punch_holes(cylinder, 0.05, 2);

    const OperationReport report = remove_form(cylinder, {FormKind::kCylinder, 2}, {});

    ASSERT_FALSE(report.refused) << *report.refused;
    EXPECT_NEAR(value(report, "radius_um"), 150.0, 1e-9);
    EXPECT_NEAR(value(report, "azimuth_deg"), GetParam().azimuth_deg, 1e-9);
    EXPECT_NEAR(value(report, "elevation_deg"), GetParam().elevation_deg, 1e-9);
    EXPECT_EQ(value(report, "side"), side);
    const Eigen::Vector3d beside(value(report, "axis_x_um") - 60.0, value(report, "axis_y_um") - 50.0,
                                 value(report, "axis_z_um") + 20.0);
    EXPECT_NEAR(beside.cross(direction()).norm(), 0.0, 1e-8);
    EXPECT_LT(largest(cylinder), 1e-9);
  }
}

TEST_P(AxisForm, FindsACone) {
  HeightField cone = field(150.0, std::tan(5.0 * kRadian), 1.0);
  punch_holes(cone, 0.05, 3);

  const OperationReport report = remove_form(cone, {FormKind::kCone, 2}, {});

  ASSERT_FALSE(report.refused) << *report.refused;
  EXPECT_NEAR(value(report, "taper_deg"), 5.0, 1e-8);
  EXPECT_NEAR(value(report, "azimuth_deg"), GetParam().azimuth_deg, 1e-8);
  EXPECT_NEAR(value(report, "elevation_deg"), GetParam().elevation_deg, 1e-8);
  const Eigen::Vector3d apex = Eigen::Vector3d(60.0, 50.0, -20.0) - direction() * 150.0 / std::tan(5.0 * kRadian);
  EXPECT_NEAR(value(report, "apex_x_um"), apex.x(), 1e-5);
  EXPECT_NEAR(value(report, "apex_y_um"), apex.y(), 1e-5);
  EXPECT_NEAR(value(report, "apex_z_um"), apex.z(), 1e-5);
  EXPECT_LT(largest(cone), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Axes, AxisForm,
                         testing::Values(Axis{0.0, 0.0}, Axis{90.0, 0.0}, Axis{37.0, 4.0}, Axis{-62.0, -7.0}));

TEST(ConeForm, FindsACountersinkThatStandsUpright) {
  HeightField field = make_field(150, 130, 1.0, 1.0, [](double x, double y) {
    const double d = std::hypot(x - 70.0, y - 61.0);
    return d < 12.0 ? kHole : 5.0 + d / std::tan(40.0 * kRadian);
  });

  const OperationReport report = remove_form(field, {FormKind::kCone, 2}, {});

  ASSERT_FALSE(report.refused);
  EXPECT_NEAR(value(report, "taper_deg"), 40.0, 1e-8);
  EXPECT_NEAR(value(report, "elevation_deg"), 90.0, 1e-6);
  EXPECT_NEAR(value(report, "apex_x_um"), 70.0, 1e-8);
  EXPECT_NEAR(value(report, "apex_z_um"), 5.0, 1e-8);
  EXPECT_LT(largest(field), 1e-9);
}

TEST(ConeForm, EndsAtItsApex) {
  HeightField field = make_field(120, 60, 1.0, 1.0, [](double x, double y) {
    const double radius = 0.3 * (x - 40.0);
    const double square = radius * radius - (y - 30.0) * (y - 30.0);
    return x > 40.0 && square > 0.0 ? std::sqrt(square) : kHole;
  });
  field.z_um.at(5, 30) = 0.0;  // where the mirrored half of the cone would be

  const OperationReport report =
      remove_form(field, {FormKind::kCone, 2}, rectangle_region(grid_of(field), {60.0, 0.0, 60.0, 60.0}));

  EXPECT_NEAR(value(report, "taper_deg"), std::atan(0.3) / kRadian, 1e-8);
  EXPECT_NEAR(value(report, "apex_x_um"), 40.0, 1e-7);
  EXPECT_EQ(report.points_removed, 1U);
  EXPECT_TRUE(field.is_hole(5, 30));
}

TEST(PlaneForm, MinimisesDistancesAtRightAngles) {
  HeightField field = make_field(40, 30, 1.0, 1.0, [](double x, double y) { return 0.8 * x - 0.4 * y; });
  add_noise(field, 3.0, 4);
  Eigen::MatrixXd points(3, 1200);
  for (int i = 0; i < 1200; ++i) points.col(i) << i % 40 + 0.5, i / 40 + 0.5, field.z_um.at(i % 40, i / 40);
  const Eigen::Vector3d centre = points.rowwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(points.colwise() - centre, Eigen::ComputeThinU);
  const Eigen::Vector3d normal = svd.matrixU().col(2);

  const OperationReport report = remove_form(field, {FormKind::kPlane, 1}, {});

  EXPECT_NEAR(value(report, "slope_x"), -normal.x() / normal.z(), 1e-12);
  EXPECT_NEAR(value(report, "slope_y"), -normal.y() / normal.z(), 1e-12);
  EXPECT_NEAR(value(report, "offset_um"), centre.dot(normal) / normal.z(), 1e-11);
  EXPECT_NEAR(value(report, "rms_um"), svd.singularValues()[2] / std::sqrt(1200.0), 1e-12);
}

TEST(PolynomialForm, RemovesEveryDegreeExactly) {
  for (int degree = 1; degree <= 6; ++degree) {
    HeightField field = make_field(90, 70, 1.0, 1.5, [degree](double x, double y) {
      double z = 0.0;
      for (int p = 0; p <= degree; ++p) {
        for (int q = 0; p + q <= degree; ++q)
          z += (1.0 + p - 2.0 * q) * std::pow(x / 45.0 - 1.0, p) * std::pow(y / 52.5 - 1.0, q);
      }
      return z;
    });
    punch_holes(field, 0.2, 5);
    field.z_um.at(0, 0) = field.z_um.at(89, 69) = 0.0;  // the block is the whole field
    field.z_um.at(0, 0) = kHole;
    field.z_um.at(89, 69) = kHole;
    const std::size_t holes = hole_count(field);

    const OperationReport report = remove_form(field, {FormKind::kPolynomial, degree}, {});

    ASSERT_FALSE(report.refused);
    EXPECT_LT(largest(field), 1e-12);
    EXPECT_EQ(hole_count(field), holes);
    for (int p = 0; p <= degree; ++p) {
      for (int q = 0; p + q <= degree; ++q) {
        const std::string name = "c_" + std::to_string(p) + std::to_string(q) + "_um";
        EXPECT_NEAR(value(report, name.c_str()), 1.0 + p - 2.0 * q, 1e-10) << name;
      }
    }
  }
}

TEST(PolynomialForm, LeavesWhatIsOfHigherDegree) {
  HeightField field = make_field(64, 64, 1.0, 1.0, [](double x, double) { return std::pow(x / 32.0 - 1.0, 3); });

  (void)remove_form(field, {FormKind::kPolynomial, 2}, {});

  EXPECT_GT(largest(field), 0.3);
}

TEST(PolynomialForm, PredictsTheScatterOfItsCoefficients) {
  double squares = 0.0;
  double predicted = 0.0;
  for (unsigned run = 0; run < 200; ++run) {
    HeightField field = make_field(30, 20, 1.0, 1.0, [](double, double) { return 0.0; });
    add_noise(field, 0.3, 300 + run);
    const OperationReport report = remove_form(field, {FormKind::kPolynomial, 3}, {});
    squares += std::pow(value(report, "c_21_um"), 2);
    predicted += std::pow(error_of(report, "c_21_um"), 2);
  }

  EXPECT_NEAR(std::sqrt(squares / predicted), 1.0, 0.15);
}

TEST(Form, IsRefusedWhereThePointsDoNotDetermineIt) {
  HeightField flat = make_field(30, 30, 1.0, 1.0, [](double x, double) { return 0.1 * x; });
  const HeightField before = flat.clone();
  const Region narrow = rectangle_region(grid_of(flat), {0.0, 0.0, 3.0, 30.0});

  EXPECT_TRUE(remove_form(flat, {FormKind::kSphere, 2}, {}).refused);
  EXPECT_TRUE(remove_form(flat, {FormKind::kCylinder, 2}, {}).refused);
  EXPECT_TRUE(remove_form(flat, {FormKind::kCone, 2}, {}).refused);
  EXPECT_TRUE(remove_form(flat, {FormKind::kPolynomial, 6}, narrow).refused);
  EXPECT_TRUE(remove_form(flat, {FormKind::kPlane, 1}, Region(30, 30)).refused);
  EXPECT_EQ(worst_difference(flat.z_um, before.z_um), 0.0);
  EXPECT_THROW((void)remove_form(flat, {FormKind::kPolynomial, 7}, {}), Error);
}

}  // namespace
}  // namespace fvd::metrology
