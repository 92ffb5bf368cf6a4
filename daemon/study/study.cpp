#include "daemon/study/study.hpp"

#include <algorithm>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxText_bytes = 2048;
constexpr std::size_t kMaxInputs_bytes = 1U << 17U;
constexpr std::int64_t kMostEntries = 10000;
constexpr NumberRange kAny{-1e300, 1e300};

void optional_number(Fields& fields, const char* name, std::optional<double>& value, const char* meaning) {
  fields.optional(name, value, [&](Fields& in, double& present) { in.number(name, present, kAny, meaning); });
}

void describe(StudyFigure& figure, Fields& fields) {
  fields.text("name", figure.name, kMaxText_bytes, "unique in the study, with its unit");
  optional_number(fields, "value", figure.value, "absent = cannot be given, see reason");
  fields.text("unit", figure.unit, kMaxText_bytes, "of the value");
  optional_number(fields, "u", figure.u, "standard uncertainty; absent = not known");
  optional_number(fields, "U", figure.expanded_u, "k u");
  optional_number(fields, "k", figure.k, "coverage factor, for 95 %");
  fields.text("reason", figure.reason, kMaxText_bytes, "why there is no value");
}

void describe(StudyValue& value, Fields& fields) {
  fields.text("job", value.job, kMaxText_bytes, "that it is of; of several of one artefact the first");
  fields.text("name", value.name, kMaxText_bytes, "measurement and value");
  fields.number("value", value.value, kAny, "as it entered the study");
  optional_number(fields, "u", value.u, "standard uncertainty");
  optional_number(fields, "reference", value.reference, "what it was compared with");
  optional_number(fields, "deviation", value.deviation, "from what the study made of all of them");
}

void describe(StudyWarning& warning, Fields& fields) {
  fields.text("code", warning.code, kMaxText_bytes, "stable, for programs");
  fields.text("text", warning.text, kMaxText_bytes, "for people");
}

}  // namespace

const StudyFigure* Study::find(std::string_view name) const noexcept {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const StudyFigure& figure) { return figure.name == name; });
  return found == figures.end() ? nullptr : &*found;
}

void describe(Study& study, Fields& fields) {
  fields.integer("format", study.format, {Study::kFormat, Study::kFormat}, "of this document");
  fields.text("id", study.id, kMaxText_bytes, "of the study, which never changes");
  fields.text("kind", study.kind, kMaxText_bytes, "the method that made it");
  fields.text("time", study.time, kMaxText_bytes, "when, UTC");
  fields.text("person", study.person, kMaxText_bytes, "who asked for it; empty = nobody said");
  fields.text("objective", study.objective, kMaxText_bytes, "of the jobs; empty = none is named");
  fields.text("software_version", study.software_version, kMaxText_bytes, "that made it");
  fields.boolean("simulated", study.simulated, "whether a job was measured with a simulator");
  fields.choices("jobs", study.jobs, {}, "the jobs, in the order given");
  fields.group("recipe", "of the jobs, or the one that they were evaluated anew with", [&](Fields& in) {
    in.text("id", study.recipe_id, kMaxText_bytes, "empty where the jobs differ");
    in.text("sha256", study.recipe_sha256, kMaxText_bytes, "empty where the jobs differ");
  });
  fields.any("inputs", study.inputs, kMaxInputs_bytes, "the parameters as given");
  fields.list("figures", study.figures, {0, kMostEntries}, "what was found",
              [](Fields& in, StudyFigure& figure) { describe(figure, in); });
  fields.list("values", study.values, {0, kMostEntries}, "what each job brought",
              [](Fields& in, StudyValue& value) { describe(value, in); });
  fields.list("warnings", study.warnings, {0, kMostEntries}, "what lowers trust in the figures",
              [](Fields& in, StudyWarning& warning) { describe(warning, in); });
  fields.list("refusals", study.refusals, {0, kMostEntries}, "parts that could not be given, and why",
              [](Fields& in, StudyWarning& refusal) { describe(refusal, in); });
  fields.choices("files", study.files, {}, "beside this one");
  fields.optional("proposal", study.proposal, [](Fields& in, Calibration& proposal) {
    in.group("proposal", "constants that calibrate.accept makes valid",
             [&](Fields& group) { describe(proposal, group); });
  });
}

std::string study_json_text(Study study) {
  return fields_to_json([&study](Fields& fields) { describe(study, fields); }).dump(2) + "\n";
}

Study read_study_json(std::string_view text, const std::string& place) {
  Study study;
  Problems problems;
  read_document(
      text, [&study](Fields& fields) { describe(study, fields); }, problems);
  if (problems.empty()) return study;
  throw Error(ErrorCode::kBadInput, place + ": " + problems.front().pointer + ": " + problems.front().message);
}

}  // namespace fvd
