#pragma once

/// Studies on a thread of their own, at low priority: a scan must not fall behind because old ones are looked at.

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/jobs/device_task.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/study/study_desk.hpp"

namespace fvd {

/// context: every function thread-safe but finish(), which is the owner's.
class StudyRunner final : public StudyService {
 public:
  /// desk outlives it. ended: called after each study's outcome is there, on the studies' thread.
  StudyRunner(StudyDesk& desk, std::function<void()> ended);
  /// finish().
  ~StudyRunner() override;
  StudyRunner(const StudyRunner&) = delete;
  StudyRunner& operator=(const StudyRunner&) = delete;

  std::shared_ptr<DeviceTask> begin(StudyRequest request) override;
  [[nodiscard]] Study get(const std::string& id) const override { return desk_.studies().get(id); }
  [[nodiscard]] std::filesystem::path folder_of(const std::string& id) const override {
    return desk_.studies().folder_of(id);
  }
  [[nodiscard]] std::vector<Study> list() const override { return desk_.studies().list(); }
  [[nodiscard]] std::vector<BrokenStudy> broken() const override { return desk_.studies().broken(); }
  AcceptedConstants accept(const AcceptRequest& request) override { return desk_.accept(request, today_utc()); }
  [[nodiscard]] std::vector<Calibration> calibrations() const override { return desk_.calibrations().versions(); }

  /// Takes no more; one that runs ends between two of its jobs, with kShuttingDown. Returns at once.
  void request_stop() noexcept;
  /// request_stop(), and waits for the thread.
  void finish();

 private:
  struct Order {
    StudyRequest request;
    std::shared_ptr<DeviceTask> task;
  };
  void run(const std::stop_token& stop);
  [[nodiscard]] DeviceTask::Outcome outcome_of(const StudyRequest& request, const std::stop_token& stop) noexcept;

  StudyDesk& desk_;
  const std::function<void()> ended_;
  ThreadTicks ticks_;
  Mutex mutex_;
  Condition changed_;
  bool busy_ FVD_GUARDED_BY(mutex_) = false;
  bool stopping_ FVD_GUARDED_BY(mutex_) = false;
  std::optional<Order> next_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

/// A study as methods answer it: study, directory, report.
[[nodiscard]] std::string study_reply_text(const Study& study, const std::filesystem::path& folder);

}  // namespace fvd
