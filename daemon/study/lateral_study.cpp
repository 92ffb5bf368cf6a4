/// The lateral scale from a cross grid, and how the picture moves with z.

#include <cmath>
#include <cstdio>

#include "core/metrology/artefact/grid_crossings.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

using metrology::CrossGridPlaces;
using metrology::GridCrossing;
using metrology::HeightField;
using metrology::LateralGrid;

struct SeenGrid {
  HeightField field;
  CrossGridPlaces places;
  double z_um = 0.0;  ///< mean of the heights
};

double mean_height_um(const HeightField& field, const metrology::Region& region) {
  double sum = 0.0;
  int points = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (field.is_hole(x, y) || !metrology::is_inside(region, x, y)) continue;
      sum += field.z_um.at(x, y);
      ++points;
    }
  }
  return points == 0 ? 0.0 : sum / points;
}

/// The pitch need not be known yet: it is what is sought. Places are in pixels.
SeenGrid seen_grid(const std::string& job, const LateralRequest& request, const metrology::GridSearch& search,
                   StudyJobs& jobs) {
  const bool knows_pitch = jobs.result(job).focus.pixel_pitch_x_um.has_value();
  if (!knows_pitch && (request.region.rectangle || request.region.circle)) {
    throw Error(ErrorCode::kStudyRefused,
                "job " + job + " does not tell its pitch, so that a region in um has no place");
  }
  SeenGrid seen;
  seen.field = jobs.field(job, {}, 1.0);
  const metrology::Region region = region_of(request.region, seen.field);
  auto found = metrology::grid_crossings(seen.field, region, search);
  if (const auto* refusal = std::get_if<metrology::StudyRefusal>(&found)) {
    throw Error(ErrorCode::kStudyRefused, "job " + job + ": " + refusal->text);
  }
  seen.places = std::get<CrossGridPlaces>(std::move(found));
  seen.z_um = mean_height_um(seen.field, region);
  return seen;
}

/// A drift that was undone is not to be seen, and what is left of it depends on where each scan began.
void refuse_undone_drift(const std::string& job, StudyJobs& jobs) {
  const auto& drift = jobs.result(job).slices.drift;
  if (!drift || drift->undone == DriftUndone::kNothing) return;
  throw Error(ErrorCode::kStudyRefused, "job " + job + ": the drift of its slices was undone by the " +
                                            std::string(drift_undone_name(drift->undone)) +
                                            ": scan both heights without, so that it shows");
}

std::string line_of(const char* form, auto... values) {
  char text[200];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

std::string deviations_csv(const std::vector<GridCrossing>& crossings, const LateralGrid& grid) {
  std::string csv = "index_x,index_y,column_px,row_px,deviation_x_um,deviation_y_um\n";
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    csv += line_of("%d,%d,%.6f,%.6f,%.6f,%.6f\n", crossings[i].index_x, crossings[i].index_y, crossings[i].column,
                   crossings[i].row, grid.deviations_x_um[i], grid.deviations_y_um[i]);
  }
  return csv;
}

void draw_deviations(const SeenGrid& seen, const LateralGrid& grid, StudyDraft& draft) {
  draft.map = study_map(floats_of(seen.field.z_um), seen.field, "height / µm", false);
  draft.map->arrows_title = "arrows: mapping deviations, the longest " + number_text(grid.deviation_max_um) + " µm";
  const std::vector<GridCrossing>& crossings = seen.places.crossings;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    draft.map->arrows.push_back(
        {crossings[i].column, crossings[i].row, grid.deviations_x_um[i], grid.deviations_y_um[i]});
  }
}

void note_grid(const SeenGrid& seen, const LateralGrid& grid, StudyDraft& draft) {
  draft.figure("pitch_x_um", grid.pitch_x_um, "um", grid.u_pitch_x_um);
  draft.figure("pitch_y_um", grid.pitch_y_um, "um", grid.u_pitch_y_um);
  draft.figure("shear", grid.shear, "1");
  draft.figure("angle_deg", grid.angle_deg, "deg");
  draft.figure("deviation_max_um", grid.deviation_max_um, "um");
  draft.figure("deviation_rms_um", grid.deviation_rms_um, "um");
  draft.figure("crossings", static_cast<double>(seen.places.crossings.size()), "1");
  draft.figure("crossings_expected", seen.places.expected, "1");
  draft.figure("line_width_x_um", seen.places.line_width_x_px * grid.pitch_x_um, "um");
  draft.figure("line_width_y_um", seen.places.line_width_y_px * grid.pitch_y_um, "um");
  draft.figure("line_height_um", seen.places.line_height_um, "um");
}

void warn_of_grid(const LateralRequest& request, const SeenGrid& seen, const LateralGrid& grid, StudyJobs& jobs,
                  StudyDraft& draft) {
  if (request.u_grid_relative == 0.0) {
    draft.warn("no_grid_uncertainty",
               "no uncertainty of the grid's pitch is told, so that u has only what the crossings scatter");
  }
  constexpr double kFew = 0.7;
  const auto crossings = static_cast<double>(seen.places.crossings.size());
  if (crossings < kFew * seen.places.expected) {
    draft.warn("few_crossings", "only " + number_text(crossings) + " of " +
                                    number_text(static_cast<double>(seen.places.expected)) + " crossings are seen");
  }
  const Result::Focus& focus = jobs.result(request.job).focus;
  constexpr double kFar = 0.01;
  const auto far = [](double found, const std::optional<double>& used) {
    return used && std::abs(found / *used - 1.0) > kFar;
  };
  if (far(grid.pitch_x_um, focus.pixel_pitch_x_um) || far(grid.pitch_y_um, focus.pixel_pitch_y_um)) {
    draft.warn("pitch_far", "the job was measured with a pitch of " + number_text(*focus.pixel_pitch_x_um) + " x " +
                                number_text(focus.pixel_pitch_y_um.value_or(0.0)) +
                                " um, more than 1 % off what is found: is grid_pitch_um that of this grid?");
  }
}

/// The place of the crossing that has the numbers 0, 0, so that both heights are numbered alike.
metrology::GridSearch search_like(const SeenGrid& first) {
  metrology::GridSearch search;
  for (const GridCrossing& crossing : first.places.crossings) {
    if (crossing.index_x == 0 && crossing.index_y == 0) search.origin = {crossing.column, crossing.row};
  }
  return search;
}

std::optional<metrology::LateralDrift> note_drift(const LateralRequest& request, const SeenGrid& first, StudyJobs& jobs,
                                                  StudyDraft& draft) {
  if (request.second_job.empty()) {
    const std::string reason = "a scan of the grid at another height tells it";
    draft.figure("drift_x_px_per_um", std::nullopt, "px/um", reason);
    draft.figure("drift_y_px_per_um", std::nullopt, "px/um", reason);
    return std::nullopt;
  }
  const SeenGrid second = seen_grid(request.second_job, request, search_like(first), jobs);
  const metrology::LateralDrift drift =
      accepted(metrology::lateral_drift(first.places.crossings, first.z_um, second.places.crossings, second.z_um));
  constexpr double kLeastRise_um = 1.0;
  if (std::abs(second.z_um - first.z_um) < kLeastRise_um) {
    throw Error(ErrorCode::kStudyRefused, "both jobs see the grid at nearly the same height, " +
                                              number_text(first.z_um) + " and " + number_text(second.z_um) +
                                              " um: a drift needs 1 um between them, better as much as a scan has");
  }
  draft.figure("drift_x_px_per_um", drift.x_px_per_um, "px/um");
  draft.figure("drift_y_px_per_um", drift.y_px_per_um, "px/um");
  draft.figure("magnification_per_mm", drift.magnification_per_mm, "1/mm");
  draft.figure("z_first_um", first.z_um, "um");
  draft.figure("z_second_um", second.z_um, "um");
  draft.figure("crossings_at_both", drift.crossings, "1");
  return drift;
}

}  // namespace

StudyDraft lateral_study(const LateralRequest& request, StudyJobs& jobs) {
  std::vector<std::string> ids{request.job};
  if (!request.second_job.empty()) ids.push_back(request.second_job);
  refuse_repeated_jobs(ids);
  StudyDraft draft;
  jobs.note(ids, "", draft.study);
  if (ids.size() > 1) {
    for (const std::string& id : ids) refuse_undone_drift(id, jobs);
  }
  const SeenGrid seen = seen_grid(request.job, request, {}, jobs);
  const LateralGrid grid =
      accepted(metrology::lateral_grid(seen.places.crossings, request.grid_pitch_um, request.u_grid_relative));
  note_grid(seen, grid, draft);
  const std::optional<metrology::LateralDrift> drift = note_drift(request, seen, jobs, draft);
  warn_of_grid(request, seen, grid, jobs, draft);
  draw_deviations(seen, grid, draft);
  draft.files.push_back({"deviations.csv", deviations_csv(seen.places.crossings, grid)});
  LateralConstants constants;
  constants.pitch_x_um = grid.pitch_x_um;
  constants.pitch_y_um = grid.pitch_y_um;
  constants.u_pitch_x_um = grid.u_pitch_x_um;
  constants.u_pitch_y_um = grid.u_pitch_y_um;
  constants.shear = grid.shear;
  constants.deviation_rms_um = grid.deviation_rms_um;
  if (drift) {
    constants.drift_px_per_um_x = drift->x_px_per_um;
    constants.drift_px_per_um_y = drift->y_px_per_um;
  }
  draft.study.proposal = proposal_for(draft.study);
  draft.study.proposal->lateral = constants;
  return draft;
}

}  // namespace fvd
