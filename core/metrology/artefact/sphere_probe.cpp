#include "core/metrology/artefact/sphere_probe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/metrology/operations/form.hpp"
#include "core/metrology/operations/level.hpp"

namespace fvd::metrology {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr int kFewestPoints = 100;
constexpr int kFewestInRing = 20;
constexpr double kFar = 6.0;          ///< robust standard deviations: so far is not on the sphere
constexpr double kLeastFar = 1e-6;    ///< of the radius
constexpr double kOfNormal = 1.4826;  ///< standard deviation over the median of |deviation|
constexpr double kLeastShare = 0.4;   ///< of the valid points that have to lie on the sphere
constexpr int kRounds = 6;
constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

struct Sphere {
  double x_um = 0.0;
  double y_um = 0.0;
  double z_um = 0.0;  ///< centre
  double radius_um = 0.0;
  double u_radius_um = 0.0;

  [[nodiscard]] double distance(double x, double y, double z) const {
    return std::sqrt((x - x_um) * (x - x_um) + (y - y_um) * (y - y_um) + (z - z_um) * (z - z_um)) - radius_um;
  }
};

void check(const HeightField& field, const SphereSettings& settings, const Region& region) {
  const auto refuse = [](const char* text) { throw Error(ErrorCode::kBadInput, text); };
  if (!(settings.radius_um > 0.0 && std::isfinite(settings.radius_um))) refuse("the radius of a sphere is above 0");
  if (!(settings.points_percent > 50.0 && settings.points_percent <= 100.0)) {
    refuse("the share of points of a form error is above 50 and at most 100 percent");
  }
  if (!(settings.ring_deg >= 0.1 && settings.ring_deg <= 10.0)) refuse("a ring of slopes is 0.1 to 10 degrees wide");
  if (!region.empty() && (region.width() != field.width() || region.height() != field.height())) {
    refuse("the region has another size than the field");
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Heights of the region alone, a bowl turned into a bump.
HeightField bump(const HeightField& field, bool bowl, const Region& region) {
  HeightField result{
      Plane<double>(field.width(), field.height()), {}, field.pitch_x_um, field.pitch_y_um, field.kernel};
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double z = field.z_um.at(x, y);
      result.z_um.at(x, y) = is_inside(region, x, y) ? (bowl ? -z : z) : kHole;
    }
  }
  return result;
}

/// A cap z = z0 - ((x - x0)^2 + (y - y0)^2) / 2R becomes a plane by adding (x^2 + y^2) / 2R: its robust fit has the
/// cap's top. What a true sphere falls beyond the parabola is added in further rounds.
std::optional<Sphere> start(const HeightField& cap, double radius_um) {
  Sphere sphere{0.5 * cap.width() * cap.pitch_x_um, 0.5 * cap.height() * cap.pitch_y_um, 0.0, radius_um, 0.0};
  for (int round = 0; round < kRounds; ++round) {
    HeightField flat = cap.clone();
    const double x0 = sphere.x_um;
    const double y0 = sphere.y_um;
    for (int y = 0; y < cap.height(); ++y) {
      for (int x = 0; x < cap.width(); ++x) {
        const double dx = cap.x_um(x) - x0;
        const double dy = cap.y_um(y) - y0;
        const double squares = dx * dx + dy * dy;
        const bool outside = squares >= radius_um * radius_um;
        flat.z_um.at(x, y) =
            outside ? kHole : cap.z_um.at(x, y) + radius_um - std::sqrt(radius_um * radius_um - squares);
      }
    }
    const OperationReport plane = level(flat, LevelMethod::kRobust, {});
    if (plane.refused) return std::nullopt;
    const double slope_x = plane.find("slope_x")->value;
    const double slope_y = plane.find("slope_y")->value;
    // A cap that stands d beside where it was taken to be has a slope of d / R there.
    sphere.x_um += std::clamp(radius_um * slope_x, -0.5 * radius_um, 0.5 * radius_um);
    sphere.y_um += std::clamp(radius_um * slope_y, -0.5 * radius_um, 0.5 * radius_um);
    sphere.z_um = plane.find("offset_um")->value + slope_x * sphere.x_um + slope_y * sphere.y_um - radius_um;
  }
  return sphere;
}

struct OnSphere {
  HeightField cap;
  std::vector<double> distances_um;
};

/// The points within the limit of the sphere; the others become holes.
OnSphere near_sphere(const HeightField& all, const Sphere& sphere, double limit_um) {
  OnSphere result{all.clone(), {}};
  for (int y = 0; y < all.height(); ++y) {
    for (int x = 0; x < all.width(); ++x) {
      double& z = result.cap.z_um.at(x, y);
      if (std::isnan(z)) continue;
      const double distance = sphere.distance(all.x_um(x), all.y_um(y), z);
      if (z > sphere.z_um && std::abs(distance) <= limit_um) {
        result.distances_um.push_back(distance);
      } else {
        z = kHole;
      }
    }
  }
  return result;
}

double limit_of(std::vector<double> distances, double radius_um) {
  if (distances.empty()) return 0.0;
  for (double& distance : distances) distance = std::abs(distance);
  return std::max(kLeastFar * radius_um, kFar * kOfNormal * median(std::move(distances)));
}

std::optional<Sphere> fitted(const HeightField& cap) {
  HeightField scratch = cap.clone();
  const OperationReport report = remove_form(scratch, {FormKind::kSphere, 2}, {});
  if (report.refused || report.find("side")->value < 0.0) return std::nullopt;
  const NamedValue& radius = *report.find("radius_um");
  return Sphere{report.find("centre_x_um")->value, report.find("centre_y_um")->value, report.find("centre_z_um")->value,
                radius.value, radius.standard_error.value_or(0.0)};
}

/// Range of the share of distances with the smallest amounts.
double range_of(std::vector<double> distances, double percent) {
  std::sort(distances.begin(), distances.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto kept =
      static_cast<std::ptrdiff_t>(std::ceil(percent / 100.0 * static_cast<double>(distances.size()) - 1e-9));
  const auto [low, high] = std::minmax_element(distances.begin(), distances.begin() + kept);
  return *high - *low;
}

/// By the place in the image, under the fitted sphere.
std::vector<SlopeRing> rings_of(const HeightField& cap, const Sphere& sphere, const Region& region, double ring_deg) {
  std::vector<SlopeRing> rings(static_cast<std::size_t>(std::ceil(90.0 / ring_deg)));
  for (std::size_t i = 0; i < rings.size(); ++i) {
    rings[i].from_deg = static_cast<double>(i) * ring_deg;
    rings[i].to_deg = std::min(90.0, rings[i].from_deg + ring_deg);
  }
  for (int y = 0; y < cap.height(); ++y) {
    for (int x = 0; x < cap.width(); ++x) {
      const double sine = std::hypot(cap.x_um(x) - sphere.x_um, cap.y_um(y) - sphere.y_um) / sphere.radius_um;
      if (sine >= 1.0 || !is_inside(region, x, y)) continue;
      const auto ring = static_cast<std::size_t>(std::asin(sine) / kDegree / ring_deg);
      if (ring >= rings.size()) continue;
      ++rings[ring].points;
      rings[ring].valid += cap.is_hole(x, y) ? 0 : 1;
    }
  }
  rings.erase(std::remove_if(rings.begin(), rings.end(), [](const SlopeRing& r) { return r.points < kFewestInRing; }),
              rings.end());
  return rings;
}

StudyRefusal no_cap(const SphereSettings& settings) {
  return {"most of the points do not lie on a cap of a sphere of a radius near " + std::to_string(settings.radius_um) +
          " um: give its region"};
}

}  // namespace

StudyOutcome<SphereProbe> sphere_probe(const HeightField& field, const SphereSettings& settings, const Region& region) {
  check(field, settings, region);
  const HeightField all = bump(field, settings.bowl, region);
  const auto valid = static_cast<double>(
      std::count_if(all.z_um.pixels().begin(), all.z_um.pixels().end(), [](double z) { return !std::isnan(z); }));
  if (valid < kFewestPoints) return StudyRefusal{"fewer than " + std::to_string(kFewestPoints) + " points are valid"};
  std::optional<Sphere> sphere = start(all, settings.radius_um);
  if (!sphere) return no_cap(settings);
  double limit_um = limit_of(near_sphere(all, *sphere, settings.radius_um).distances_um, settings.radius_um);
  OnSphere on;
  for (int round = 0; round < kRounds; ++round) {
    on = near_sphere(all, *sphere, limit_um);
    if (static_cast<double>(on.distances_um.size()) < std::max<double>(kFewestPoints, kLeastShare * valid)) {
      return no_cap(settings);
    }
    sphere = fitted(on.cap);
    const bool alike =
        sphere && sphere->radius_um > 0.5 * settings.radius_um && sphere->radius_um < 2.0 * settings.radius_um;
    if (!alike) return no_cap(settings);
    limit_um = limit_of(near_sphere(all, *sphere, limit_um).distances_um, settings.radius_um);
  }
  on = near_sphere(all, *sphere, limit_um);

  SphereProbe probe;
  double squares = 0.0;
  double sum = 0.0;
  for (const double distance : on.distances_um) {
    sum += distance;
    squares += distance * distance;
  }
  const auto points = static_cast<double>(on.distances_um.size());
  probe.radius_um = sphere->radius_um;
  probe.u_radius_um = sphere->u_radius_um;
  probe.centre_x_um = sphere->x_um;
  probe.centre_y_um = sphere->y_um;
  probe.centre_z_um = settings.bowl ? -sphere->z_um : sphere->z_um;
  probe.form_error_um = range_of(on.distances_um, settings.points_percent);
  probe.form_error_all_um = range_of(on.distances_um, 100.0);
  probe.size_error_um = 2.0 * (sphere->radius_um - settings.radius_um);
  probe.sd_um = std::sqrt(std::max(0.0, squares - sum * sum / points) / (points - 1.0));
  probe.points = static_cast<int>(on.distances_um.size());
  probe.points_percent = settings.points_percent;
  probe.rings = rings_of(on.cap, *sphere, region, settings.ring_deg);
  for (const SlopeRing& ring : probe.rings) {
    probe.max_slope_deg = ring.to_deg;
    if (2 * ring.valid >= ring.points) probe.slope_limit_deg = ring.to_deg;
  }
  return probe;
}

}  // namespace fvd::metrology
