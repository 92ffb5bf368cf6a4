#include "daemon/result/evaluation_result.hpp"

namespace fvd {

namespace {

constexpr NumberRange kAnyNumber{-1e300, 1e300};
constexpr std::size_t kMaxText_bytes = 4096;
constexpr std::size_t kMaxDetails_bytes = 1U << 20U;

void optional_number(Fields& fields, const char* key, std::optional<double>& value, const char* meaning) {
  fields.optional(key, value, [&](Fields& in, double& number) { in.number(key, number, kAnyNumber, meaning); });
}

void optional_text(Fields& fields, const char* key, std::string& value, const char* meaning) {
  bool present = !value.empty();
  fields.optional_field(key, present, [&](Fields& in) { in.text(key, value, kMaxText_bytes, meaning); });
}

void optional_verdict(Fields& fields, const char* key, std::optional<Verdict>& verdict, const char* meaning) {
  std::optional<std::string> name;
  if (verdict) name = std::string(verdict_name(*verdict));
  fields.optional(key, name, [&](Fields& in, std::string& word) {
    in.choice(key, word, {"pass", "fail", "uncertain", "invalid"}, meaning);
  });
  verdict = name ? verdict_from_name(*name) : std::nullopt;
}

void describe(EvaluationWarning& warning, Fields& fields) {
  fields.text("code", warning.code, kMaxText_bytes, "for programs");
  fields.text("text", warning.text, kMaxText_bytes, "for people");
}

void describe_warnings(std::vector<EvaluationWarning>& warnings, Fields& fields) {
  fields.list("warnings", warnings, {0, 1000}, "what lowers trust",
              [](Fields& in, EvaluationWarning& warning) { describe(warning, in); });
}

void describe(UncertaintyLine& line, Fields& fields) {
  fields.text("source", line.source, kMaxText_bytes, "where it comes from");
  fields.choice("type", line.type, {"A", "B"}, "A: from observations of this measurement, B: from elsewhere");
  fields.number("u", line.u, kAnyNumber, "standard uncertainty in the unit of the value");
  optional_number(fields, "dof", line.dof, "degrees of freedom; absent = infinite");
  optional_number(fields, "points_as_one", line.points_as_one, "so many neighbouring points count as one");
}

void describe(Limits& limits, Fields& fields) {
  optional_number(fields, "lower", limits.lower, "a smaller value fails");
  optional_number(fields, "upper", limits.upper, "a larger value fails");
}

void describe(EvaluatedValue& value, Fields& fields) {
  optional_number(fields, "value", value.value, "absent = cannot be given");
  fields.text("unit", value.unit, 16, "of value, u, U and limits");
  optional_text(fields, "reason", value.reason, "why there is no value");
  optional_number(fields, "u", value.u, "standard uncertainty; absent = not known");
  optional_number(fields, "U", value.expanded_u, "expanded uncertainty k u, 95 %");
  optional_number(fields, "k", value.k, "coverage factor");
  optional_number(fields, "dof", value.dof, "effective degrees of freedom; absent = infinite, or not known");
  optional_text(fields, "u_method", value.u_method, "how u was found: linear, monte_carlo, jacobian, spread, repeated");
  fields.list("budget", value.budget, {0, 100}, "what u consists of",
              [](Fields& in, UncertaintyLine& line) { describe(line, in); });
  fields.optional("limits", value.limits, [](Fields& in, Limits& limits) {
    in.group("limits", "of the recipe", [&](Fields& group) { describe(limits, group); });
  });
  optional_verdict(fields, "verdict", value.verdict, "present where limits are");
  optional_number(fields, "probability", value.probability, "of conformity");
  describe_warnings(value.warnings, fields);
}

void describe(CrossSection::Region& region, Fields& fields) {
  fields.text("name", region.name, kMaxText_bytes, "of the region");
  fields.number("from_um", region.from_um, kAnyNumber, "along the line");
  fields.number("to_um", region.to_um, kAnyNumber, "along the line");
}

void describe(CrossSection::Curve& curve, Fields& fields) {
  constexpr IntegerRange kPoints{1, 1000};
  fields.numbers("along_um", curve.along_um, kAnyNumber, kPoints, "along the line");
  fields.numbers("z_um", curve.z_um, kAnyNumber, kPoints, "measured heights, as many");
}

void describe(CrossSection& section, Fields& fields) {
  fields.number("from_x_um", section.from_x_um, kAnyNumber, "where the line begins");
  fields.number("from_y_um", section.from_y_um, kAnyNumber, "likewise, downwards");
  fields.number("to_x_um", section.to_x_um, kAnyNumber, "where it ends");
  fields.number("to_y_um", section.to_y_um, kAnyNumber, "likewise");
  fields.number("band_width_um", section.band_width_um, kAnyNumber, "across the line");
  fields.list("regions", section.regions, {0, 100}, "that count",
              [](Fields& in, CrossSection::Region& region) { describe(region, in); });
  optional_text(fields, "fit_name", section.fit_name, "what was fitted");
  bool fitted = !section.fit.empty();
  fields.optional_field("fit", fitted, [&](Fields& in) {
    in.list("fit", section.fit, {1, 200}, "lines of the fit",
            [](Fields& inner, CrossSection::Curve& curve) { describe(curve, inner); });
  });
}

void describe(EvaluatedMeasurement& measurement, Fields& fields) {
  fields.text("id", measurement.id, 4, "for PLCs");
  fields.text("kind", measurement.kind, kMaxText_bytes, "what was measured");
  optional_text(fields, "method", measurement.method, "by which method");
  fields.text("surface", measurement.surface, kMaxText_bytes, "on which surface");
  optional_text(fields, "region", measurement.region, "in which region");
  optional_text(fields, "reason", measurement.reason, "why it is invalid");
  bool coded = measurement.reason_code != 0;
  fields.optional_field("reason_code", coded, [&](Fields& in) {
    in.integer("reason_code", measurement.reason_code, {0, 9999}, "of that reason");
  });
  fields.integer("points", measurement.points, {0, INT64_MAX}, "valid points");
  fields.number("valid_fraction", measurement.valid_fraction, {0.0, 1.0}, "of the points it was to rest on");
  optional_text(fields, "main_value", measurement.main_value, "the value that stands for the measurement");
  fields.map("values", measurement.values, "by name with unit",
             [](Fields& in, const std::string& key, EvaluatedValue& value) {
               in.group(key, "a value", [&](Fields& group) { describe(value, group); });
             });
  fields.choices("not_evaluated", measurement.not_evaluated, {}, "what no budget contains");
  fields.any("details", measurement.details, kMaxDetails_bytes, "traces, sections, conditions");
  fields.optional("cross_section", measurement.cross_section, [](Fields& in, CrossSection& section) {
    in.group("cross_section", "where it looked, for pictures", [&](Fields& group) { describe(section, group); });
  });
  describe_warnings(measurement.warnings, fields);
  optional_verdict(fields, "verdict", measurement.verdict, "the worst of its values'");
}

}  // namespace

void describe(Evaluation& evaluation, Fields& fields) {
  optional_verdict(fields, "verdict", evaluation.verdict, "the worst of the measurements'");
  fields.text("rule", evaluation.rule, 32, "of the decision");
  fields.number("probability", evaluation.probability, {0.0, 1.0}, "that pass and fail need");
  fields.text("calibration", evaluation.calibration, kMaxText_bytes, "that was used, or none");
  fields.map("surfaces", evaluation.surfaces, "each surface's steps with what they did",
             [](Fields& in, const std::string& key, std::string& steps) {
               in.any(key, steps, kMaxDetails_bytes, "a surface");
             });
  fields.choices("order", evaluation.order, {}, "of the measurements");
  fields.map("measurements", evaluation.measurements, "by name",
             [](Fields& in, const std::string& key, EvaluatedMeasurement& measurement) {
               in.group(key, "a measurement", [&](Fields& group) { describe(measurement, group); });
             });
}

}  // namespace fvd
