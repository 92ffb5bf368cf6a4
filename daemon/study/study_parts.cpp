#include "daemon/study/study_parts.hpp"

namespace fvd {

namespace {

void describe(Fields& fields, PlannedRectangle& rectangle) {
  fields.group("rectangle_um", "an upright rectangle, from the outer corner of the first pixel", [&](Fields& sides) {
    sides.number("x", rectangle.x_um, kStudyPlace_um, "left end");
    sides.require("x");
    sides.number("y", rectangle.y_um, kStudyPlace_um, "upper end");
    sides.require("y");
    sides.number("width", rectangle.width_um, positive(1e6), "to the right");
    sides.require("width");
    sides.number("height", rectangle.height_um, positive(1e6), "down");
    sides.require("height");
  });
}

void describe(Fields& fields, StudyCircle& circle) {
  fields.group("circle_um", "a circle, from the outer corner of the first pixel", [&](Fields& parts) {
    parts.number("x", circle.x_um, kStudyPlace_um, "of its centre, to the right");
    parts.require("x");
    parts.number("y", circle.y_um, kStudyPlace_um, "of its centre, down");
    parts.require("y");
    parts.number("radius", circle.radius_um, positive(1e6), "of the circle");
    parts.require("radius");
  });
}

}  // namespace

void describe_jobs(Fields& fields, std::vector<std::string>& jobs, const char* meaning) {
  fields.choices("jobs", jobs, {}, meaning);
  fields.require("jobs");
}

void describe_job(Fields& fields, std::string& job, const char* meaning) {
  fields.text("job", job, kMaxStudyJob_bytes, meaning);
  fields.require("job");
}

void describe_region(Fields& fields, StudyRegion& region) {
  fields.group("region", "the part of the field that counts: what lies in both; absent = all of it", [&](Fields& in) {
    in.optional("rectangle_um", region.rectangle,
                [](Fields& inner, PlannedRectangle& rectangle) { describe(inner, rectangle); });
    in.optional("circle_um", region.circle, [](Fields& inner, StudyCircle& circle) { describe(inner, circle); });
  });
}

void describe_choice(Fields& fields, EvaluatedChoice& what) {
  fields.text("measurement", what.measurement, kMaxStudyName_bytes, "its name in the recipe");
  fields.require("measurement");
  fields.text("value", what.value, kMaxStudyName_bytes, "with its unit; empty = the measurement's main value");
}

void describe_evaluated(Fields& fields, std::string& recipe, bool& require_calibration) {
  fields.text("recipe", recipe, kMaxStudyJob_bytes,
              "whose evaluation the jobs' surfaces are given to anew; empty = the values that the jobs have");
  fields.boolean("require_calibration", require_calibration,
                 "refuse jobs that were evaluated without constants of the instrument");
}

void describe_optional(Fields& fields, const char* name, std::optional<double>& value, NumberRange range,
                       const char* meaning) {
  fields.optional(name, value, [&](Fields& in, double& present) { in.number(name, present, range, meaning); });
}

}  // namespace fvd
