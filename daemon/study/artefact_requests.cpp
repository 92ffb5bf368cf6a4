#include "daemon/study/artefact_requests.hpp"

namespace fvd {

void LateralRequest::describe(Fields& fields) {
  describe_job(fields, job, "id of a scan of a cross grid");
  fields.number("grid_pitch_um", grid_pitch_um, positive(1e6), "of the grid's lines, by the certificate");
  fields.require("grid_pitch_um");
  fields.number("u_grid_relative", u_grid_relative, {0.0, 0.1},
                "standard uncertainty of that pitch over the pitch: its U over its k and over the pitch; 0 = not told");
  fields.text("second_job", second_job, kMaxStudyJob_bytes,
              "id of a scan of the same grid at another height, for the drift of the picture; empty = none");
  describe_region(fields, region);
}

void ResolutionRequest::describe(Fields& fields) {
  describe_job(fields, job);
  fields.choice("artefact", artefact, {kStar, kEdge}, "what was scanned");
  fields.require("artefact");
  describe_optional(fields, "height_um", height_um, positive(1e6),
                    "true height of a star's raised sectors; absent = as it is measured near the rim");
  fields.optional("pairs", pairs, [](Fields& in, int& present) {
    in.integer("pairs", present, {4, 180}, "of a star's sectors, raised and not; absent = found");
  });
  describe_region(fields, region);
}

void SphereRequest::describe(Fields& fields) {
  describe_job(fields, job, "id of a scan of a sphere's cap");
  fields.number("radius_um", radius_um, positive(1e6), "of the sphere, by the certificate");
  fields.require("radius_um");
  fields.number("u_radius_um", u_radius_um, {0.0, 1e6}, "standard uncertainty of that radius; 0 = not told");
  fields.boolean("bowl", bowl, "the surface is the inner side of the sphere");
  describe_region(fields, region);
}

void HysteresisRequest::describe(Fields& fields) {
  fields.text("up", up, kMaxStudyJob_bytes, "id of a job that was scanned upwards");
  fields.require("up");
  fields.text("down", down, kMaxStudyJob_bytes, "id of a job of the same part, not moved, scanned downwards");
  fields.require("down");
  describe_region(fields, region);
}

void TextureRequest::describe(Fields& fields) {
  describe_jobs(fields, jobs,
                "ids of 2 to 200 scans of one surface, put in place anew each time; 10 or more are usual");
  describe_choice(fields, what);
  describe_evaluated(fields, recipe, require_calibration);
}

}  // namespace fvd
