/// Self tests, calibration, capability: studies of jobs that exist. Nothing moves.

#include <algorithm>
#include <functional>

#include "config/field_writer.hpp"
#include "daemon/api/methods/device_task.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/jobs/study_runner.hpp"

namespace fvd {

namespace {

/// A study's own parameters, and who asks for it as the last.
template <typename Request>
struct AskedBy {
  Request request;
  std::string person;

  void describe(Fields& fields) {
    request.describe(fields);
    fields.text("person", person, kMaxForeignText_bytes, "who asks for it; empty = nobody says");
  }
};

struct StudyParams {
  std::string id;

  void describe(Fields& fields) {
    fields.text("id", id, kMaxForeignText_bytes, "of the study, as study-0007");
    fields.require("id");
  }
};

struct ListParams {
  std::string kind;
  int most = 100;

  void describe(Fields& fields) {
    fields.text("kind", kind, kMaxForeignText_bytes, "only those of this kind, or beginning with it; empty = all");
    fields.integer("most", most, {1, 10000}, "so many of the newest");
  }
};

struct CalibrationParams {
  std::string id;
  std::string objective;

  void describe(Fields& fields) {
    fields.text("id", id, kMaxForeignText_bytes, "of the version, as cal-0003; empty = the newest of the objective");
    fields.text("objective", objective, kMaxForeignText_bytes, "whose constants; empty = where none is named");
  }
};

void describe_study(Fields& fields) {
  const ResultFields result(fields);
  result.any(
      "study",
      "an object: id, kind, time, person, objective, simulated, jobs, recipe, inputs, figures (name, value, unit, "
      "u, U, k, or a reason), values, warnings, refusals, files, proposal");
  result.text("directory", "with study.json, its maps and report.pdf");
  result.text("report", "path of the report");
}

void describe_list(Fields& fields) {
  const ResultFields result(fields);
  result.any("studies",
             "list, the newest first: id, kind, time, person, objective, recipe, jobs (how many), simulated, warnings "
             "(how many), calibration (the version that was made of it; null = none, absent = it proposes nothing)");
  result.any("broken", "list of studies that cannot be read: id, reason");
}

void describe_accepted(Fields& fields) {
  const ResultFields result(fields);
  result.text("calibration", "id of the version that has the constants");
  result.boolean("already", "the study had been accepted before; nothing was changed");
  result.any("constants", "the version, an object");
}

void describe_calibration(Fields& fields) {
  const ResultFields result(fields);
  result.any("calibration", "the version, an object: id, objective, created, z, flatness, noise, lateral, texture");
  result.any("lapsed", "list of its parts whose last day is past");
  result.any("versions", "list of the ids of the objective's versions, the newest first");
}

Reply calibration_json(Calibration calibration) {
  return fields_to_json([&calibration](Fields& fields) { describe(calibration, fields); });
}

bool is_from(const Calibration& version, const std::string& study) {
  const auto from = [&study](const auto& part) { return part && part->origin.study == study; };
  return from(version.z) || from(version.flatness) || from(version.noise) || from(version.lateral) ||
         from(version.texture);
}

Reply list_entry(const Study& study, const std::vector<Calibration>& versions) {
  Reply entry{{"id", study.id},
              {"kind", study.kind},
              {"time", study.time},
              {"person", study.person},
              {"objective", study.objective},
              {"recipe", study.recipe_id},
              {"jobs", study.jobs.size()},
              {"simulated", study.simulated},
              {"warnings", study.warnings.size()}};
  if (!study.proposal) return entry;
  const auto version = std::find_if(versions.begin(), versions.end(),
                                    [&study](const Calibration& one) { return is_from(one, study.id); });
  entry["calibration"] = version == versions.end() ? Reply(nullptr) : Reply(version->id);
  return entry;
}

Reply list(const StudyService& studies, const ListParams& params) {
  Reply reply{{"studies", Reply::array()}, {"broken", Reply::array()}};
  const std::vector<Calibration> versions = studies.calibrations();
  for (const Study& study : studies.list()) {
    if (!study.kind.starts_with(params.kind)) continue;
    if (reply["studies"].size() == static_cast<std::size_t>(params.most)) break;
    reply["studies"].push_back(list_entry(study, versions));
  }
  for (const BrokenStudy& broken : studies.broken()) {
    reply["broken"].push_back({{"id", broken.id}, {"reason", broken.reason}});
  }
  return reply;
}

Reply get(const StudyService& studies, const std::string& id) {
  return Reply::parse(study_reply_text(studies.get(id), studies.folder_of(id)));
}

Reply accept(StudyService& studies, const AcceptRequest& request) {
  const AcceptedConstants accepted = studies.accept(request);
  return {{"calibration", accepted.calibration.id},
          {"already", accepted.already},
          {"constants", calibration_json(accepted.calibration)}};
}

Reply calibration(const StudyService& studies, const CalibrationParams& params) {
  std::vector<Calibration> versions = studies.calibrations();
  std::reverse(versions.begin(), versions.end());
  const auto found = std::find_if(versions.begin(), versions.end(), [&params](const Calibration& version) {
    return params.id.empty() ? version.objective == params.objective : version.id == params.id;
  });
  if (found == versions.end()) {
    const std::string objective = params.objective.empty() ? "yet" : "for the objective '" + params.objective + "'";
    const std::string which = params.id.empty() ? objective : "'" + params.id + "'";
    throw Error(ErrorCode::kCalibrationMissing, "there are no constants " + which + "; see calibrate.accept");
  }
  Reply reply{
      {"calibration", calibration_json(*found)}, {"lapsed", lapsed(*found, today_utc())}, {"versions", Reply::array()}};
  for (const Calibration& version : versions) {
    if (version.objective == found->objective) reply["versions"].push_back(version.id);
  }
  return reply;
}

/// A method that makes a study of this kind.
template <typename Request>
void add_study(MethodTable& methods, const Services& services, const std::string& kind, const std::string& summary) {
  using enum ErrorCode;
  // What proposes constants is for whoever may make them valid.
  const Role role = kind.starts_with("calibrate.") ? Role::kAdminister : Role::kSetUp;
  methods[kind] = {.about = {.summary = summary,
                             .role = role,
                             .params = described<AskedBy<Request>>(),
                             .result = describe_study,
                             .errors = {kStudyRefused, kUnknownJob, kUnknownRecipe, kBadRecipe, kCalibrationMissing,
                                        kRegionOutside, kSurfaceFile, kMemoryBudget, kBadInput, kBusy, kTimeout,
                                        kStorageFull, kStorageWrite, kDatabase, kShuttingDown},
                             .may_wait = true,
                             .needs_id = true},
                   .run = with<AskedBy<Request>>(
                       [&studies = services.studies, kind](const Call& call, const AskedBy<Request>& params) -> Answer {
                         require_wait(call);
                         return reply_when_done(studies.begin({kind, params.person, params.request}));
                       })};
}

void add_reading_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  methods["study.list"] = {
      .about = {.summary = "The studies that were made",
                .role = Role::kView,
                .params = described<ListParams>(),
                .result = describe_list},
      .run = with<ListParams>(
          [&studies = services.studies](const Call&, const ListParams& params) { return list(studies, params); })};
  methods["study.get"] = {
      .about = {.summary = "One study with its figures, and where its files are",
                .role = Role::kView,
                .params = described<StudyParams>(),
                .result = describe_study,
                .errors = {kStudyRefused}},
      .run = with<StudyParams>(
          [&studies = services.studies](const Call&, const StudyParams& params) { return get(studies, params.id); })};
  methods["calibration.get"] = {
      .about = {.summary = "The constants of the instrument, in force or of any version",
                .role = Role::kView,
                .params = described<CalibrationParams>(),
                .result = describe_calibration,
                .errors = {kCalibrationMissing}},
      .run = with<CalibrationParams>([&studies = services.studies](const Call&, const CalibrationParams& params) {
        return calibration(studies, params);
      })};
}

}  // namespace

void add_study_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  add_study<NoiseRequest>(methods, services, "verify.noise",
                          "Measurement noise N_M from scans of one part; changes nothing");
  add_study<NoiseRequest>(methods, services, "calibrate.noise", "The same, and proposes it as the instrument's");
  add_study<FlatnessRequest>(methods, services, "verify.flatness",
                             "Flatness deviation z_FLT from scans of a flat; changes nothing");
  add_study<FlatnessRequest>(methods, services, "calibrate.flatness",
                             "The same, and proposes its mean map as the reference map");
  add_study<StepRequest>(
      methods, services, "verify.step",
      "Amplification alpha_z and linearity l_z, from steps of known height as they are measured with "
      "the constants in force; changes nothing");
  add_study<StepRequest>(methods, services, "calibrate.z",
                         "Proposes alpha_z and l_z from steps of known height, as the axis gave them");
  add_study<LinearityRequest>(methods, services, "verify.linearity",
                              "Linearity l_z over the range, from one step at several z; changes nothing");
  add_study<LateralRequest>(methods, services, "calibrate.lateral",
                            "Proposes pitch, shear and, from a second height, drift, from a scan of a cross grid");
  add_study<ResolutionRequest>(methods, services, "verify.resolution",
                               "Lateral resolution W_R and D_LIM from a star or an edge; changes nothing");
  add_study<SphereRequest>(methods, services, "verify.sphere",
                           "Probing errors P_F and P_S and the slope limit from a sphere's cap; changes nothing");
  add_study<HysteresisRequest>(methods, services, "verify.hysteresis",
                               "What a scan downwards sees otherwise than one upwards, and its plane; changes nothing");
  add_study<TextureRequest>(
      methods, services, "verify.texture",
      "Reproducibility of a texture value in percent, from scans of one surface put in place anew; changes nothing");
  add_study<TextureRequest>(methods, services, "calibrate.texture", "The same, and proposes it as the instrument's");
  add_study<Type1Request>(methods, services, "gauge.type1", "Bias, Cg and Cgk from many scans of one part");
  add_study<RrRequest>(methods, services, "gauge.rr",
                       "Repeatability and reproducibility from parts x operators x trials, by analysis of variance");
  add_study<CapabilityRequest>(methods, services, "gauge.capability",
                               "Q_MS and Q_MP of VDA 5 from a study of the kind gauge.type1 and one of gauge.rr");
  methods["calibrate.accept"] = {
      .about = {.summary = "Makes the constants that a study proposes valid; a study that was accepted already changes "
                           "nothing",
                .role = Role::kAdminister,
                .params = described<AcceptRequest>(),
                .result = describe_accepted,
                .errors = {kStudyRefused, kBadInput, kObjectiveMismatch, kSurfaceFile, kStorageFull, kStorageWrite},
                .is_audited = true,
                .needs_id = true},
      .run = with<AcceptRequest>([&studies = services.studies](const Call&, const AcceptRequest& request) {
        return accept(studies, request);
      })};
  add_reading_methods(methods, services);
}

}  // namespace fvd
