#include "daemon/study/study_input.hpp"

#include <map>

#include "config/field_reader.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/recipes/recipe_masks.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

using Read = StudyInput (*)(const std::string& json, std::string& person, Problems& problems);

template <typename Request>
StudyInput read_as(const std::string& json, std::string& person, Problems& problems) {
  Request request;
  read_document(
      json,
      [&](Fields& fields) {
        request.describe(fields);
        fields.text("person", person, kMaxStudyName_bytes, "who asks for it");
      },
      problems);
  return request;
}

const std::map<std::string, Read, std::less<>>& kinds() {
  static const std::map<std::string, Read, std::less<>> all{{"verify.noise", read_as<NoiseRequest>},
                                                            {"calibrate.noise", read_as<NoiseRequest>},
                                                            {"verify.flatness", read_as<FlatnessRequest>},
                                                            {"calibrate.flatness", read_as<FlatnessRequest>},
                                                            {"verify.step", read_as<StepRequest>},
                                                            {"calibrate.z", read_as<StepRequest>},
                                                            {"verify.linearity", read_as<LinearityRequest>},
                                                            {"calibrate.lateral", read_as<LateralRequest>},
                                                            {"verify.resolution", read_as<ResolutionRequest>},
                                                            {"verify.sphere", read_as<SphereRequest>},
                                                            {"verify.hysteresis", read_as<HysteresisRequest>},
                                                            {"verify.texture", read_as<TextureRequest>},
                                                            {"calibrate.texture", read_as<TextureRequest>},
                                                            {"gauge.type1", read_as<Type1Request>},
                                                            {"gauge.rr", read_as<RrRequest>}};
  return all;
}

StoredJob job_of_folder(const std::string& folder) {
  const std::filesystem::path json = std::filesystem::path(folder) / "result.json";
  if (!std::filesystem::is_regular_file(json)) {
    throw Error(ErrorCode::kUnknownJob, "'" + folder + "' is no folder of a result: it has no result.json");
  }
  StoredJob job;
  job.status.job_id = folder;
  job.status.state = JobState::kCompleted;
  job.result_dir = folder;
  job.result_json = read_text_file(json);
  return job;
}

}  // namespace

StudyRequest read_study_request(const std::string& kind, const std::string& json) {
  const auto known = kinds().find(kind);
  if (known == kinds().end()) throw Error(ErrorCode::kBadInput, "'" + kind + "' is no study of jobs");
  Problems problems;
  StudyRequest request;
  request.kind = kind;
  request.input = known->second(json, request.person, problems);
  if (problems.empty()) return request;
  throw Error(ErrorCode::kBadInput, to_text(problems, kind));
}

Study study_of_folders(const StudyRequest& request, const std::filesystem::path& calibration_folder) {
  StudySources sources;
  sources.job = job_of_folder;
  sources.recipe = [](const std::string& file) { return read_recipe_file(file); };
  sources.memory_budget_bytes = std::size_t{4} << 30U;
  sources.calibration_folder = calibration_folder;
  StudyJobs jobs(sources, {});
  StudyDraft draft = draft_of_jobs(request, jobs);
  note_request(request, draft.study);
  return std::move(draft.study);
}

}  // namespace fvd
