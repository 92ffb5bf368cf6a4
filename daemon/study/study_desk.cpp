#include "daemon/study/study_desk.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/export/json_values.hpp"
#include "daemon/study/studies.hpp"
#include "daemon/study/study_report.hpp"
#include "daemon/surface_files/file_bytes.hpp"

namespace fvd {

namespace {

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::kStudyRefused, why); }

bool is_printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= 0x20 && c != 0x7F; });
}

void check_acceptable(const Study& study, const AcceptRequest& request, bool simulated) {
  if (!study.proposal) refuse(study.id + " is of the kind " + study.kind + ", which proposes no constants");
  if (!study.refusals.empty()) refuse(study.id + " is incomplete: " + study.refusals.front().text);
  if (study.simulated && !simulated)
    refuse(study.id + " is of simulated jobs: such constants are not the instrument's");
  if (request.objective && *request.objective != study.objective) {
    throw Error(ErrorCode::kObjectiveMismatch,
                study.id + " is of the objective '" + study.objective + "', not '" + *request.objective + "'");
  }
}

void check_person_and_date(const AcceptRequest& request, const std::string& today) {
  const auto blank = [](char c) { return c == ' '; };
  if (std::all_of(request.person.begin(), request.person.end(), blank) || !is_printable(request.person)) {
    throw Error(ErrorCode::kBadInput, "person: a name is needed");
  }
  if (!is_printable(request.certificate)) throw Error(ErrorCode::kBadInput, "certificate: is no text of one line");
  if (!is_date(request.renew_by)) {
    throw Error(ErrorCode::kBadInput, "renew_by: '" + request.renew_by + "' is no date as 2027-11-29");
  }
  if (request.renew_by < today) {
    throw Error(ErrorCode::kBadInput, "renew_by: " + request.renew_by + " is past; today is " + today);
  }
}

/// Whether a part of the version came from the study.
bool is_from(const Calibration& version, const std::string& study) {
  const auto from = [&study](const auto& part) { return part && part->origin.study == study; };
  return from(version.z) || from(version.flatness) || from(version.noise) || from(version.lateral) ||
         from(version.texture);
}

/// The first version that has constants of the study: later ones took them over.
std::optional<Calibration> version_of(const CalibrationBook& book, const std::string& study) {
  for (Calibration& version : book.versions()) {
    if (is_from(version, study)) return std::move(version);
  }
  return std::nullopt;
}

std::string bytes_of(const std::filesystem::path& path) {
  const FileBytes file(path);
  return file.text(0, file.size());
}

/// The reference map goes beside the constants, under the version's name.
std::vector<CalibrationFile> take_over(const Study& study, const std::filesystem::path& folder,
                                       const ConstantsOrigin& origin, Calibration& next) {
  std::vector<CalibrationFile> files;
  const auto take = [&origin](const auto& proposed, auto& part) {
    if (!proposed) return;
    part = proposed;
    part->origin = origin;
  };
  const std::optional<ZConstants> before = next.z;
  take(study.proposal->z, next.z);
  if (study.proposal->z && before) {  // of the stage, not of steps
    next.z->lead_amplitude_um = before->lead_amplitude_um;
    next.z->lead_um = before->lead_um;
  }
  take(study.proposal->noise, next.noise);
  const std::optional<LateralConstants> lateral_before = next.lateral;
  take(study.proposal->lateral, next.lateral);
  const StudyFigure* const drift = study.find("drift_x_px_per_um");
  if (study.proposal->lateral && lateral_before && (drift == nullptr || !drift->value)) {  // of one height alone
    next.lateral->drift_px_per_um_x = lateral_before->drift_px_per_um_x;
    next.lateral->drift_px_per_um_y = lateral_before->drift_px_per_um_y;
  }
  take(study.proposal->texture, next.texture);
  take(study.proposal->flatness, next.flatness);
  if (!study.proposal->flatness) return files;
  next.flatness->reference = next.id + "-flatness.gsf";
  files.push_back({next.flatness->reference, bytes_of(folder / "flatness_reference.gsf")});
  files.push_back({next.id + "-flatness-sigma.gsf", bytes_of(folder / "flatness_sigma.gsf")});
  return files;
}

}  // namespace

std::string today_utc() {
  constexpr std::size_t kDateLength = 10;
  return iso8601_utc(std::chrono::system_clock::now()).substr(0, kDateLength);
}

bool is_date(const std::string& text) {
  const std::string form = "dddd-dd-dd";
  if (text.size() != form.size()) return false;
  for (std::size_t i = 0; i < form.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (form[i] == 'd' ? !digit : text[i] != '-') return false;
  }
  const std::chrono::year_month_day day{std::chrono::year(std::stoi(text.substr(0, 4))),
                                        std::chrono::month(static_cast<unsigned>(std::stoi(text.substr(5, 2)))),
                                        std::chrono::day(static_cast<unsigned>(std::stoi(text.substr(8, 2))))};
  return day.ok();
}

StudyDesk::StudyDesk(StudySources sources, StudyBook& studies, CalibrationBook& calibrations, bool simulated)
    : sources_(std::move(sources)), studies_(studies), calibrations_(calibrations), simulated_(simulated) {}

StudyDraft StudyDesk::draft(const StudyRequest& request, StudyJobs& jobs) const {
  if (const auto* of_studies = std::get_if<CapabilityRequest>(&request.input)) {
    return capability_study(*of_studies, studies_.get(of_studies->type1), studies_.get(of_studies->rr));
  }
  return draft_of_jobs(request, jobs);
}

Study StudyDesk::make(const StudyRequest& request, std::stop_token stop, std::function<void()> alive) {
  const MutexLock lock(making_);
  StudyJobs jobs(sources_, std::move(stop), std::move(alive));
  StudyDraft made = draft(request, jobs);
  note_request(request, made.study);
  StudyPage page = study_page(made);
  return studies_.keep(std::move(made), [&page](const Study& study) {
    set_identity(study, page);
    return study_pdf(page);
  });
}

AcceptedConstants StudyDesk::accept(const AcceptRequest& request, const std::string& today) {
  const MutexLock lock(accepting_);
  const Study study = studies_.get(request.study);
  check_acceptable(study, request, simulated_);
  if (auto version = version_of(calibrations_, study.id)) return {std::move(*version), true};
  check_person_and_date(request, today);
  ConstantsOrigin origin;
  origin.study = study.id;
  origin.person = request.person;
  origin.certificate = request.certificate;
  origin.renew_by = request.renew_by;
  origin.simulated = study.simulated;
  return {calibrations_.add(study.objective,
                            [&](Calibration& next) {
                              origin.accepted = next.created;
                              if (!simulated_) drop_simulated(next);
                              return take_over(study, studies_.folder_of(study.id), origin, next);
                            }),
          false};
}

}  // namespace fvd
