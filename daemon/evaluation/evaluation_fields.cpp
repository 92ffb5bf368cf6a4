#include "daemon/evaluation/evaluation_fields.hpp"

#include <algorithm>

#include "daemon/evaluation/reason_names.hpp"
#include "daemon/evaluation/value_names.hpp"

namespace fvd {

namespace {

constexpr NumberRange kLength_um{-1e6, 1e6};
constexpr NumberRange kAnyValue{-1e9, 1e9};
constexpr std::size_t kMaxNameLength = 64;

void required_name(Fields& fields, const char* key, std::string& name, const char* meaning) {
  fields.text(key, name, kMaxNameLength, meaning);
  fields.require(key);
}

void optional_number(Fields& fields, const char* key, std::optional<double>& value, NumberRange range,
                     const char* meaning) {
  fields.optional(key, value, [&](Fields& in, double& number) { in.number(key, number, range, meaning); });
}

void describe(PlannedRectangle& rectangle, Fields& fields) {
  fields.number("x", rectangle.x_um, kLength_um, "left side");
  fields.require("x");
  fields.number("y", rectangle.y_um, kLength_um, "upper side");
  fields.require("y");
  fields.number("width", rectangle.width_um, positive(1e6), "to the right");
  fields.require("width");
  fields.number("height", rectangle.height_um, positive(1e6), "down");
  fields.require("height");
}

void describe_rectangle(Fields& fields, PlannedRectangle& rectangle, const char* meaning) {
  fields.group("rectangle_um", meaning, [&](Fields& in) { describe(rectangle, in); });
}

void describe_point(PlannedPoint& point, Fields& fields) {
  fields.number("0", point.x_um, kLength_um, "x");
  fields.require("0");
  fields.number("1", point.y_um, kLength_um, "y");
  fields.require("1");
}

void describe(PlannedRegion& region, Fields& fields) {
  const auto of_parts = [&region](const char* name, const char* meaning) {
    return Shape{name, [&region, name, meaning](Fields& in) { in.choices(name, region.parts, {}, meaning); }};
  };
  fields.keyed_variant(
      region.shape,
      {{"rectangle_um", [&](Fields& in) { describe_rectangle(in, region.rectangle, "an upright rectangle"); }},
       {"polygon_um",
        [&](Fields& in) {
          in.list("polygon_um", region.polygon, {3, 1000}, "corners [x, y]",
                  [](Fields& row, PlannedPoint& point) { describe_point(point, row); }, {"point_um", true});
        }},
       {"circle_um",
        [&](Fields& in) {
          in.group("circle_um", "a circle", [&](Fields& circle) {
            circle.number("x", region.centre.x_um, kLength_um, "of its centre");
            circle.require("x");
            circle.number("y", region.centre.y_um, kLength_um, "of its centre");
            circle.require("y");
            circle.number("radius", region.radius_um, positive(1e6), "its radius");
            circle.require("radius");
          });
        }},
       {"mask_png",
        [&](Fields& in) {
          in.text("mask_png", region.mask_png, kMaxNameLength,
                  "a file in the folder masks beside the recipes: 8 bit grey, as large as the image; 0 = outside");
        }},
       {"threshold_um",
        [&](Fields& in) {
          in.group("threshold_um", "the points whose height lies within these", [&](Fields& heights) {
            optional_number(heights, "above", region.above_um, kLength_um, "this or higher");
            optional_number(heights, "below", region.below_um, kLength_um, "this or lower");
          });
          in.boolean("largest", region.largest, "of the points that lie within, only the largest connected part");
        }},
       {"not",
        [&](Fields& in) {
          std::string part = region.parts.empty() ? "" : region.parts.front();
          in.text("not", part, kMaxNameLength, "every point that is not in this region");
          region.parts = {part};
        }},
       of_parts("union", "points that are in one of these regions"),
       of_parts("intersection", "points that are in all of these regions")});
  fields.number("shrink_um", region.shrink_um, {0.0, 1e5}, "points nearer to the region's border do not belong to it");
}

void describe_fitted_regions(PlannedOperation& step, Fields& fields) {
  fields.choices("regions", step.regions, {}, "fitted to the points of these regions; none = to all");
}

void describe_form(PlannedOperation& step, Fields& fields) {
  fields.choice("form", step.form, {"plane", "polynomial", "cylinder", "sphere", "cone"}, "what is taken away");
  fields.integer("degree", step.degree, {1, 6}, "of a polynomial");
  describe_fitted_regions(step, fields);
}

void describe_level(PlannedOperation& step, Fields& fields) {
  fields.choice("form", step.form, {"plane"}, "what is taken away");
  fields.choice("fit", step.fit, {"least_squares", "weighted", "robust"},
                "weighted: by 1 / sigma^2; robust: points far from the plane count less or not at all");
  describe_fitted_regions(step, fields);
}

void describe_filter(PlannedOperation& step, Fields& fields) {
  fields.choice("side", step.side, {"S", "L"}, "S takes the short wavelengths away, L the long ones");
  fields.require("side");
  fields.number("nesting_um", step.nesting_um, positive(1e5), "nesting index (cut-off wavelength)");
  fields.require("nesting_um");
  fields.choice("method", step.method, {"gaussian", "gaussian_regression_1", "gaussian_regression_2"},
                "ISO 16610-61, or -71 with local polynomials of degree 1 or 2");
  fields.boolean("robust", step.robust, "points far from the filtered surface count less or not at all");
  fields.boolean("keep_margin", step.keep_margin,
                 "L by gaussian: keep the margin of half a nesting index, which the border distorts");
}

}  // namespace

void describe(PlannedOperation& step, Fields& fields) {
  fields.variant(
      "op", step.op,
      {{"lateral", [](Fields&) {}},
       {"flatness_reference", [](Fields&) {}},
       {"mask_reasons",
        [&](Fields& in) {
          in.choices("reasons", step.reasons, reason_names(), "points that carry one of these become holes");
          in.require("reasons");
        }},
       {"mask_sigma",
        [&](Fields& in) {
          in.number("max_sigma_um", step.max_sigma_um, positive(1e5), "points of a larger standard error become holes");
          in.require("max_sigma_um");
        }},
       {"outliers",
        [&](Fields& in) {
          in.integer("window_px", step.window_px, {3, 31}, "side of the window around a point, odd");
          in.number("limit", step.limit, positive(1e3),
                    "a point further from the median of its window than so many of its deviations becomes a hole");
        }},
       {"level", [&](Fields& in) { describe_level(step, in); }},
       {"form", [&](Fields& in) { describe_form(step, in); }},
       {"filter", [&](Fields& in) { describe_filter(step, in); }},
       {"crop",
        [&](Fields& in) {
          describe_rectangle(in, step.rectangle, "what is kept; everything else becomes a hole");
          in.require("rectangle_um");
        }},
       {"shift_z",
        [&](Fields& in) {
          in.number("by_um", step.by_um, kLength_um, "added to every height");
          in.require("by_um");
        }},
       {"invert", [](Fields&) {}}},
      "the operation");
  fields.require("op");
}

namespace {

void describe(PlannedSurface& surface, Fields& fields) {
  fields.text("from", surface.from, kMaxNameLength, "the surface that it is made of; measured = as the scan made it");
  fields.list("steps", surface.steps, {0, 32}, "what is done to it, in this order",
              [](Fields& in, PlannedOperation& step) { describe(step, in); });
}

void describe_region_of(PlannedMeasurement& measurement, Fields& fields) {
  fields.text("region", measurement.region, kMaxNameLength, "what is measured; empty = everywhere");
}

/// Kinds share the member, and a schema describes them all: what another kind has is not this one's default.
void describe_method(PlannedMeasurement& measurement, Fields& fields, const std::vector<std::string>& methods,
                     const char* meaning) {
  const bool own = std::find(methods.begin(), methods.end(), measurement.method) != methods.end();
  std::string method = own ? measurement.method : methods.front();
  fields.choice("method", method, methods, meaning);
  measurement.method = method;
}

void describe_step_height(PlannedMeasurement& measurement, Fields& fields) {
  describe_method(measurement, fields, {"iso5436_a1", "iso5436_a2"}, "a groove or ridge of flat or of rounded bottom");
  fields.choice("across", measurement.across, {"x", "y"}, "direction of the traces, across the groove");
  fields.numbers("band_from_to_um", measurement.band_from_to_um, kLength_um, {0, 2},
                 "the traces lie in this band of the other direction; empty = everywhere");
  fields.integer("traces", measurement.traces, {5, 1000}, "evenly distributed over the band");
  fields.numbers("edges_um", measurement.edges_um, kLength_um, {0, 2},
                 "where the groove begins and ends; empty = at the steepest points of the median trace");
}

void describe_step_between(PlannedMeasurement& measurement, Fields& fields) {
  required_name(fields, "lower", measurement.lower, "the region that is measured from");
  required_name(fields, "upper", measurement.upper, "the region whose height above it is measured");
  fields.choice("slope", measurement.slope, {"common_plane", "from_lower", "from_upper", "fixed"},
                "both regions have one slope, or that of one of them, or none as the surface is levelled");
}

void describe_levels(PlannedMeasurement& measurement, Fields& fields) {
  fields.choices("regions", measurement.regions, {}, "two or more; the height of each above each before it");
  fields.require("regions");
}

void describe_areal(PlannedMeasurement& measurement, Fields& fields) {
  describe_region_of(measurement, fields);
  fields.choices("parameters", measurement.parameters, areal_value_names(), "of ISO 25178-2");
  fields.require("parameters");
}

void describe_profile(PlannedMeasurement& measurement, Fields& fields) {
  fields.numbers("from_um", measurement.from_um, kLength_um, {2, 2}, "x, y where the profile begins");
  fields.require("from_um");
  fields.numbers("to_um", measurement.to_um, kLength_um, {2, 2}, "x, y where it ends");
  fields.require("to_um");
  fields.number("band_width_um", measurement.band_width_um, {0.0, 1e5},
                "mean over a band so wide across the profile; 0 = along one line");
  fields.choices("parameters", measurement.parameters, profile_value_names(), "of ISO 21920-2");
  fields.require("parameters");
  fields.number("nesting_um", measurement.nesting_um, positive(1e5), "of the L filter of the R parameters");
  fields.integer("sections", measurement.sections, {1, 100}, "that the evaluation length has");
}

void describe_chipping(PlannedChipping& chipping, Fields& fields) {
  fields.number("min_depth_um", chipping.min_depth_um, {0.0, 1e4}, "a notch is at least so deep");
  fields.number("min_width_um", chipping.min_width_um, {0.0, 1e4}, "and so wide");
  fields.number("max_unmeasured_fraction", chipping.max_unmeasured_fraction, {0.0, 1.0},
                "of the edge; more makes the measurement invalid");
}

void describe_edge(PlannedMeasurement& measurement, Fields& fields) {
  describe_region_of(measurement, fields);
  describe_method(
      measurement, fields, {"model", "tolerance"},
      "model: where the rounding ends follows from the fit; tolerance: where it leaves the flank by this much");
  fields.number("tolerance_um", measurement.tolerance_um, positive(100.0), "of the method tolerance");
  fields.choice("rake_side", measurement.rake_side, {"left", "right", "top", "bottom"},
                "where the rake face lies in the image");
  fields.number("sections_every_um", measurement.sections_every_um, positive(1e5),
                "each section is the mean over so much along the edge");
  fields.choice("model", measurement.model, {"conic", "circle"}, "of the rounding");
  fields.numbers("flank_um", measurement.flank_um, positive(1e6), {2, 2},
                 "nearest and farthest distance from the edge at which the flanks are flat");
  fields.require("flank_um");
  fields.optional("chipping", measurement.chipping, [](Fields& in, PlannedChipping& chipping) {
    in.group("chipping", "notches of the edge line", [&](Fields& group) { describe_chipping(chipping, group); });
  });
}

void describe(Limits& limits, const std::string& key, Fields& fields) {
  fields.group(key, "limits of one value, by its name with its unit", [&](Fields& in) {
    optional_number(in, "lower", limits.lower, kAnyValue, "a smaller value fails");
    optional_number(in, "upper", limits.upper, kAnyValue, "a larger value fails");
  });
}

void describe(PlannedMeasurement& measurement, Fields& fields) {
  fields.variant("kind", measurement.kind,
                 {{"step_height", [&](Fields& in) { describe_step_height(measurement, in); }},
                  {"step_between", [&](Fields& in) { describe_step_between(measurement, in); }},
                  {"levels", [&](Fields& in) { describe_levels(measurement, in); }},
                  {"areal", [&](Fields& in) { describe_areal(measurement, in); }},
                  {"profile", [&](Fields& in) { describe_profile(measurement, in); }},
                  {"cutting_edge", [&](Fields& in) { describe_edge(measurement, in); }}},
                 "what is measured");
  fields.require("kind");
  fields.text("id", measurement.id, 4,
              "its name in compact results for PLCs; empty = the first 4 characters of its name");
  fields.text("surface", measurement.surface, kMaxNameLength, "the surface that it is measured on");
  fields.number("min_valid_fraction", measurement.min_valid_fraction, {0.0, 1.0},
                "of a region's points; with fewer the measurement is invalid");
  fields.map("limits", measurement.limits, "of its values, by name with unit",
             [](Fields& in, const std::string& key, Limits& limits) { describe(limits, key, in); });
}

}  // namespace

void describe(EvaluationPlan& plan, Fields& fields) {
  fields.map("surfaces", plan.surfaces, "that measurements are made on; each is computed once",
             [](Fields& in, const std::string& key, PlannedSurface& surface) {
               in.group(key, "a surface", [&](Fields& group) { describe(surface, group); });
             });
  fields.map("regions", plan.regions, "parts of the field of view, in um from its upper left corner",
             [](Fields& in, const std::string& key, PlannedRegion& region) {
               in.group(key, "a region", [&](Fields& group) { describe(region, group); });
             });
  fields.map("measurements", plan.measurements, "what is measured",
             [](Fields& in, const std::string& key, PlannedMeasurement& measurement) {
               in.group(key, "a measurement", [&](Fields& group) { describe(measurement, group); });
             });
  optional_number(fields, "expansion_per_k", plan.expansion_per_k, {0.0, 1e-3},
                  "linear thermal expansion of the part per kelvin, such as 11.5e-6 of steel; absent = not known");
  fields.group("decision", "how limits are judged", [&](Fields& in) {
    in.choice("rule", plan.decision.rule, {"iso14253_1", "simple", "guard_U"},
              "iso14253_1: by the probability of conformity; simple: by the value alone; guard_U: U inside the limits");
    in.number("probability", plan.decision.probability, {0.5, 0.9999, true}, "that pass and fail need");
  });
}

}  // namespace fvd
