/// Studies of one artefact in one scan: lateral resolution, and a sphere's cap.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/metrology/artefact/edge_response.hpp"
#include "core/metrology/artefact/siemens_star.hpp"
#include "core/metrology/artefact/sphere_probe.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

using metrology::HeightField;
using metrology::SphereProbe;

std::string whole_text(double value) { return number_text(std::round(value)); }

void draw_heights(const HeightField& field, StudyDraft& draft) {
  draft.map = study_map(floats_of(field.z_um), field, "height / µm", false);
}

void note_directions(const metrology::StarResolution& star, StudyDraft& draft) {
  StudyPlot plot{"W_R by direction", "azimuth / °", "width / µm", {}};
  for (const metrology::StarDirection& direction : star.directions) {
    const std::string at = "at_" + whole_text(direction.azimuth_deg) + "_deg_um";
    draft.figure("width_" + at, direction.width_um, "um", direction.reason);
    draft.figure("period_" + at, direction.period_um, "um", direction.reason);
    if (direction.width_um) plot.points.push_back({direction.azimuth_deg, *direction.width_um, {}});
  }
  draft.plot = std::move(plot);
}

void star_resolution(const ResolutionRequest& request, const HeightField& field, StudyDraft& draft) {
  metrology::StarSettings settings;
  settings.pairs = request.pairs;
  settings.height_um = request.height_um;
  const metrology::StarResolution star =
      accepted(metrology::siemens_star(field, settings, region_of(request.region, field)));
  draft.figure("width_um", star.width_um, "um");
  draft.figure("period_um", star.period_um, "um");
  draft.figure("height_um", star.height_um, "um");
  draft.figure("pairs", star.pairs, "1");
  draft.figure("radius_um", star.radius_um, "um");
  note_directions(star, draft);
  if (!star.height_given) {
    draft.warn("height_measured", "the star's true height is not told: widths are against the height near its rim");
  }
}

void edge_resolution(const ResolutionRequest& request, const HeightField& field, StudyDraft& draft) {
  if (request.height_um || request.pairs) {
    throw Error(ErrorCode::kStudyRefused, "height_um and pairs are of a star; the artefact is an edge");
  }
  const metrology::EdgeResponse edge = accepted(metrology::edge_response(field, region_of(request.region, field)));
  draft.figure("width_10_90_um", edge.width_10_90_um, "um");
  draft.figure("period_um", edge.period_um, "um", edge.reason);
  draft.figure("across_deg", edge.across_deg, "deg");
  draft.figure("edge_deg", edge.edge_deg, "deg");
  draft.figure("height_um", edge.height_um, "um");
  draft.figure("straightness_px", edge.straightness_px, "px");
  draft.figure("points", edge.points, "1");
}

/// The points of a sphere's surroundings, by their distance from its axis.
struct Surroundings {
  double from_um = 0.0;  ///< inner end of the first ring of which most points are measured and not on the sphere
  double share = 0.0;    ///< of the region's valid points that lie in such rings
};

double distance_um(const SphereProbe& probe, bool bowl, const HeightField& field, int x, int y) {
  const double sign = bowl ? -1.0 : 1.0;
  const double along = sign * (field.z_um.at(x, y) - probe.centre_z_um);
  const double across = std::hypot(field.x_um(x) - probe.centre_x_um, field.y_um(y) - probe.centre_y_um);
  // Beside or below its middle there is no cap.
  if (along <= 0.0) return -probe.radius_um;
  return std::hypot(across, along) - probe.radius_um;
}

/// Six standard deviations of the points on the sphere: what the probe calls near.
double near_um(const SphereProbe& probe) { return std::max(6.0 * probe.sd_um, 1e-6 * probe.radius_um); }

/// What is measured around a cap and is no sphere: the base that it stands on.
std::optional<Surroundings> base_of(const SphereProbe& probe, bool bowl, const HeightField& field,
                                    const metrology::Region& region) {
  struct Ring {
    int points = 0;
    int valid = 0;
    int off = 0;
  };
  constexpr int kFewest = 20;
  const double width_um = 2.0 * std::max(field.pitch_x_um, field.pitch_y_um);
  std::vector<Ring> rings;
  int valid = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (!metrology::is_inside(region, x, y)) continue;
      const double across = std::hypot(field.x_um(x) - probe.centre_x_um, field.y_um(y) - probe.centre_y_um);
      const auto index = static_cast<std::size_t>(across / width_um);
      if (index >= rings.size()) rings.resize(index + 1);
      ++rings[index].points;
      if (field.is_hole(x, y)) continue;
      ++valid;
      ++rings[index].valid;
      rings[index].off += std::abs(distance_um(probe, bowl, field, x, y)) > near_um(probe) ? 1 : 0;
    }
  }
  std::optional<Surroundings> base;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (rings[i].points < kFewest || 2 * rings[i].off < rings[i].points) continue;
    if (!base) base = Surroundings{static_cast<double>(i) * width_um, 0.0};
    base->share += static_cast<double>(rings[i].off) / valid;
  }
  return base;
}

/// A circle about the cap that ends where neither the base nor the window over the rim is in it.
[[noreturn]] void refuse_base(const Surroundings& base, const SphereProbe& probe, const HeightField& field) {
  const double pitch_um = std::max(field.pitch_x_um, field.pitch_y_um);
  const double sine = std::clamp(base.from_um / probe.radius_um, 0.05, 1.0);
  const double radius_um = base.from_um - near_um(probe) / sine - (field.kernel.reach_px() + 1) * pitch_um;
  const std::string where = number_text(100.0 * base.share) +
                            " % of the region's points are measured and not on the sphere, from " +
                            number_text(base.from_um) + " um beside its axis on: a base meets the cap's rim there. ";
  if (radius_um <= pitch_um) throw Error(ErrorCode::kStudyRefused, where + "Give a region that ends inside the rim");
  const double down_um = std::floor(radius_um * 100.0) / 100.0;
  throw Error(ErrorCode::kStudyRefused, where + "Give a region inside the rim, such as circle_um x " +
                                            number_text(probe.centre_x_um) + ", y " + number_text(probe.centre_y_um) +
                                            ", radius " + number_text(down_um));
}

void note_sphere(const SphereRequest& request, const SphereProbe& probe, StudyDraft& draft) {
  const double u_um = std::hypot(probe.u_radius_um, request.u_radius_um);
  draft.figure("size_error_um", probe.size_error_um, "um", 2.0 * u_um);
  draft.figure("form_error_um", probe.form_error_um, "um");
  draft.figure("form_error_all_um", probe.form_error_all_um, "um");
  draft.figure("slope_limit_deg", probe.slope_limit_deg, "deg", "no ring of slopes has half of its points");
  draft.figure("max_slope_deg", probe.max_slope_deg, "deg");
  draft.figure("radius_um", probe.radius_um, "um", probe.u_radius_um);
  draft.figure("sd_um", probe.sd_um, "um");
  draft.figure("centre_x_um", probe.centre_x_um, "um");
  draft.figure("centre_y_um", probe.centre_y_um, "um");
  draft.figure("centre_z_um", probe.centre_z_um, "um");
  draft.figure("points", probe.points, "1");
  draft.figure("form_error_of_points", probe.points_percent, "%");
  if (probe.slope_limit_deg && *probe.slope_limit_deg >= probe.max_slope_deg) {
    draft.warn("slope_limit_not_reached",
               "the region ends before the instrument's limit of slopes: slope_limit_deg is "
               "that of the region, the limit is at or above it");
  }
  if (request.u_radius_um == 0.0) {
    draft.warn("no_radius_uncertainty", "no uncertainty of the sphere's radius is told: U of P_S has only the fit's");
  }
}

void draw_sphere(const SphereRequest& request, const SphereProbe& probe, const HeightField& field,
                 const metrology::Region& region, StudyDraft& draft) {
  Plane<float> um = Plane<float>::unset(field.width(), field.height());
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const bool counts = metrology::is_inside(region, x, y) && !field.is_hole(x, y);
      const double distance = counts ? distance_um(probe, request.bowl, field, x, y) : std::nan("");
      um.at(x, y) = std::abs(distance) <= near_um(probe) ? static_cast<float>(distance) : std::nanf("");
    }
  }
  draft.map = study_map(um, field, "distance from the fitted sphere / µm", false);
  draft.files.push_back(
      {"deviations.gsf", gsf_of_um(um, field.pitch_x_um, field.pitch_y_um, "distance from the fitted sphere")});
  StudyPlot plot{"measured points by slope", "slope / °", "measured / %", {}};
  for (const metrology::SlopeRing& ring : probe.rings) {
    plot.points.push_back({0.5 * (ring.from_deg + ring.to_deg), 100.0 * ring.valid / ring.points, {}});
  }
  draft.plot = std::move(plot);
}

}  // namespace

StudyDraft resolution_study(const ResolutionRequest& request, StudyJobs& jobs) {
  StudyDraft draft;
  jobs.note({request.job}, "", draft.study);
  const HeightField field = jobs.field(request.job);
  if (request.artefact == ResolutionRequest::kStar) {
    star_resolution(request, field, draft);
  } else {
    edge_resolution(request, field, draft);
  }
  draw_heights(field, draft);
  return draft;
}

StudyDraft sphere_study(const SphereRequest& request, StudyJobs& jobs) {
  StudyDraft draft;
  jobs.note({request.job}, "", draft.study);
  const HeightField field = jobs.field(request.job);
  const metrology::Region region = region_of(request.region, field);
  metrology::SphereSettings settings;
  settings.radius_um = request.radius_um;
  settings.bowl = request.bowl;
  const SphereProbe probe = accepted(metrology::sphere_probe(field, settings, region));
  if (const auto base = base_of(probe, request.bowl, field, region)) refuse_base(*base, probe, field);
  note_sphere(request, probe, draft);
  draw_sphere(request, probe, field, region, draft);
  return draft;
}

}  // namespace fvd
