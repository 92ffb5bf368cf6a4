#include "core/metrology/artefact/sphere_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/uncertainty/random_normal.hpp"
#include "tests/core/metrology/artefact/artefact_fields.hpp"

namespace fvd::metrology {
namespace {

using testing::add_holes;
using testing::mirrored;

constexpr double kRadius_um = 500.0;

/// A cap of the radius on a base, the top at (230.5, 170) and z = 120; pitches 2 and 1.8 um.
HeightField cap(double base_um = -1e9, double radius_um = kRadius_um, double noise_um = 0.0) {
  HeightField field{Plane<double>(240, 200), {}, 2.0, 1.8, {}};
  RandomNormal random(5);
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double squares = std::pow(field.x_um(x) - 230.5, 2) + std::pow(field.y_um(y) - 170.0, 2);
      // Along the sphere's normal, as its noise is told.
      const double radius = radius_um + noise_um * random.normal();
      const double z = 120.0 - radius_um + std::sqrt(std::max(0.0, radius * radius - squares));
      field.z_um.at(x, y) = std::max(base_um, z);
    }
  }
  return field;
}

SphereProbe probed(const HeightField& field, const SphereSettings& settings, const Region& region = {}) {
  const auto outcome = sphere_probe(field, settings, region);
  if (const auto* refusal = std::get_if<StudyRefusal>(&outcome)) ADD_FAILURE() << refusal->text;
  return std::holds_alternative<SphereProbe>(outcome) ? std::get<SphereProbe>(outcome) : SphereProbe{};
}

bool refused(const HeightField& field, const SphereSettings& settings, const Region& region = {}) {
  return std::holds_alternative<StudyRefusal>(sphere_probe(field, settings, region));
}

TEST(SphereProbe, FindsTheSphereBesideHoles) {
  HeightField field = cap();
  add_holes(field, 0.05, 1);

  const SphereProbe probe = probed(field, {.radius_um = kRadius_um});

  EXPECT_NEAR(probe.radius_um, kRadius_um, 1e-6);
  EXPECT_NEAR(probe.centre_x_um, 230.5, 1e-7);
  EXPECT_NEAR(probe.centre_y_um, 170.0, 1e-7);
  EXPECT_NEAR(probe.centre_z_um, 120.0 - kRadius_um, 1e-6);
  EXPECT_NEAR(probe.size_error_um, 0.0, 2e-6);
  EXPECT_NEAR(probe.form_error_all_um, 0.0, 1e-6);
  EXPECT_NEAR(probe.sd_um, 0.0, 1e-7);
  EXPECT_NEAR(probe.points, 0.95 * 240 * 200, 300);
}

TEST(SphereProbe, HasSizeAndFormErrors) {
  const SphereProbe probe = probed(cap(-1e9, 502.0, 0.2), {.radius_um = kRadius_um, .points_percent = 95.0});

  EXPECT_NEAR(probe.size_error_um, 4.0, 6.0 * probe.u_radius_um);
  EXPECT_LT(probe.u_radius_um, 0.04);
  EXPECT_NEAR(probe.sd_um, 0.2, 0.002);
  EXPECT_EQ(probe.points_percent, 95.0);
  EXPECT_NEAR(probe.form_error_um, 2.0 * 1.959964 * 0.2, 0.02);
  EXPECT_GT(probe.form_error_all_um, 8.0 * 0.2);
  EXPECT_LT(probe.form_error_all_um, 12.0 * 0.2);
}

TEST(SphereProbe, LeavesOutTheBaseAndOutliers) {
  HeightField field = cap(60.0, kRadius_um, 0.1);  // the cap ends at a radius of 237 um
  for (int x = 50; x < 200; x += 3) field.z_um.at(x, 95) += 20.0;

  const SphereProbe probe = probed(field, {.radius_um = kRadius_um});

  // The base next to the cap's rim lies within the noise of the sphere.
  EXPECT_NEAR(probe.size_error_um, 0.0, 0.4);
  EXPECT_LT(probe.form_error_all_um, 1.5);
  ASSERT_TRUE(probe.slope_limit_deg);
  // sin^-1(sqrt(500^2 - 440^2) / 500) = 28.36 degrees: the base is not the sphere.
  EXPECT_NEAR(*probe.slope_limit_deg, 28.36, 1.0);
  EXPECT_GT(probe.max_slope_deg, *probe.slope_limit_deg + 1.0);
}

TEST(SphereProbe, FindsTheSlopeThatIsStillMeasured) {
  HeightField field = cap(-1e9, kRadius_um, 0.1);
  const double limit_um = kRadius_um * std::sin(20.0 * M_PI / 180.0);
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double from = std::hypot(field.x_um(x) - 230.5, field.y_um(y) - 170.0);
      // Every third point is seen beyond.
      if (from > limit_um && (x + y) % 3 != 0) field.z_um.at(x, y) = std::numeric_limits<double>::quiet_NaN();
    }
  }

  const SphereProbe probe = probed(field, {.radius_um = kRadius_um, .ring_deg = 0.5});
  const SphereProbe all = probed(cap(), {.radius_um = kRadius_um});

  EXPECT_EQ(probe.slope_limit_deg, 20.0);
  EXPECT_EQ(all.slope_limit_deg, all.max_slope_deg);
  const auto ring =
      std::find_if(probe.rings.begin(), probe.rings.end(), [](const SlopeRing& r) { return r.from_deg == 21.0; });
  ASSERT_NE(ring, probe.rings.end());
  EXPECT_NEAR(1.0 * ring->valid / ring->points, 1.0 / 3.0, 0.03);
}

TEST(SphereProbe, LooksIntoABowlAndIntoAMirror) {
  const HeightField field = cap(-1e9, kRadius_um, 0.1);
  HeightField bowl = field.clone();
  for (double& z : bowl.z_um.pixels()) z = -z;

  const SphereProbe probe = probed(field, {.radius_um = kRadius_um});
  const SphereProbe inner = probed(bowl, {.radius_um = kRadius_um, .bowl = true});
  const SphereProbe other = probed(mirrored(field), {.radius_um = kRadius_um});

  EXPECT_EQ(inner.radius_um, probe.radius_um);
  EXPECT_EQ(inner.centre_z_um, -probe.centre_z_um);
  EXPECT_NEAR(other.radius_um, probe.radius_um, 1e-7);
  EXPECT_NEAR(480.0 - other.centre_x_um, probe.centre_x_um, 1e-7);
  EXPECT_TRUE(refused(bowl, {.radius_um = kRadius_um}));
}

TEST(SphereProbe, FindsASmallCapInItsRegion) {
  const HeightField field = cap(110.0, kRadius_um, 0.05);  // radius 99.5 um: a sixth of the field
  Region region(240, 200, 0);
  for (int y = 45; y < 145; ++y) {
    for (int x = 65; x < 165; ++x) region.at(x, y) = 1;
  }

  const SphereProbe probe = probed(field, {.radius_um = kRadius_um}, region);

  EXPECT_NEAR(probe.radius_um, kRadius_um, 1.5);  // a flat cap: 11 degrees at its rim
  EXPECT_TRUE(refused(field, {.radius_um = kRadius_um}));
}

TEST(SphereProbe, IsRefusedWhereThereIsNoSphere) {
  HeightField flat = cap();
  for (double& z : flat.z_um.pixels()) z = 3.0;
  HeightField empty = cap();
  add_holes(empty, 1.1, 1);

  EXPECT_TRUE(refused(flat, {.radius_um = kRadius_um}));
  EXPECT_TRUE(refused(empty, {.radius_um = kRadius_um}));
  EXPECT_TRUE(refused(cap(), {.radius_um = kRadius_um}, Region(240, 200, 0)));
  EXPECT_TRUE(refused(cap(), {.radius_um = 5.0 * kRadius_um}));
}

TEST(SphereProbe, NeedsSettingsInTheirRange) {
  const HeightField field = cap();
  for (const SphereSettings& settings :
       {SphereSettings{}, SphereSettings{.radius_um = 1.0, .points_percent = 50.0},
        SphereSettings{.radius_um = 1.0, .points_percent = 101.0}, SphereSettings{.radius_um = 1.0, .ring_deg = 0.0}}) {
    EXPECT_THROW(static_cast<void>(sphere_probe(field, settings)), Error);
  }
  EXPECT_THROW(static_cast<void>(sphere_probe(field, {.radius_um = kRadius_um}, Region(3, 3, 1))), Error);
}

}  // namespace
}  // namespace fvd::metrology
