#pragma once

/// Makes studies of jobs, keeps them, and makes the constants that they propose valid.

#include <functional>
#include <stop_token>
#include <string>

#include "core/base/mutex.hpp"
#include "daemon/calibration/calibration_book.hpp"
#include "daemon/study/study_book.hpp"
#include "daemon/study/study_jobs.hpp"
#include "daemon/study/study_requests.hpp"

namespace fvd {

struct AcceptedConstants {
  Calibration calibration;
  bool already = false;  ///< the study had been accepted before: nothing was changed
};

/// context: every function thread-safe; blocks for files, and while another study is being made.
class StudyDesk {
 public:
  /// books outlive it. simulated: the instrument is a simulator.
  StudyDesk(StudySources sources, StudyBook& studies, CalibrationBook& calibrations, bool simulated);

  /// Moves nothing. Returns the study as it is kept. Throws Error kStudyRefused with one sentence, kUnknownJob,
  /// kUnknownRecipe, kBadRecipe, kCalibrationMissing, kRegionOutside, kSurfaceFile, kMemoryBudget, kBadInput,
  /// kStorageFull, kStorageWrite, kShuttingDown; nothing is kept then.
  /// alive: see StudyJobs.
  Study make(const StudyRequest& request, std::stop_token stop, std::function<void()> alive = {});

  /// A new version of the constants from what the study proposes. Accepting a study again returns the version that was
  /// made of it. today: "2026-11-29". Throws Error kStudyRefused for studies that propose nothing, that have refusals,
  /// or that are of a simulator where the instrument is none; kBadInput for a person that is no name or a renew_by that
  /// is no date or past; kObjectiveMismatch; kStorageFull, kStorageWrite.
  AcceptedConstants accept(const AcceptRequest& request, const std::string& today);

  [[nodiscard]] StudyBook& studies() noexcept { return studies_; }
  [[nodiscard]] const StudyBook& studies() const noexcept { return studies_; }
  [[nodiscard]] const CalibrationBook& calibrations() const noexcept { return calibrations_; }

 private:
  [[nodiscard]] StudyDraft draft(const StudyRequest& request, StudyJobs& jobs) const;

  const StudySources sources_;
  StudyBook& studies_;
  CalibrationBook& calibrations_;
  const bool simulated_;
  Mutex making_;     // one study's maps are in memory at a time
  Mutex accepting_;  // between looking for a version of the study and making one
};

/// The day of now, UTC, "2026-11-29".
[[nodiscard]] std::string today_utc();
/// Whether it is a day of the calendar in that form.
[[nodiscard]] bool is_date(const std::string& text);

}  // namespace fvd
