#pragma once

/// A machine whose status a test changes, and whose listeners are told.

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/base/mutex.hpp"
#include "daemon/jobs/services.hpp"
#include "tests/daemon/api/fake_job_service.hpp"

namespace fvd::test {

class ChangingMachine final : public MachineView {
 public:
  ChangingMachine() {
    MachineStatus status;
    status.state = ScanState::kReady;
    status.epoch = 17;
    status_ = std::make_shared<const MachineStatus>(status);
  }
  /// These services with this machine.
  [[nodiscard]] Services in(const Services& others) {
    return {*this,          others.jobs,    others.results, others.tasks,  others.recipes,  others.objectives,
            others.studies, others.control, others.audit,   others.access, others.refusals, others.history,
            others.alarms};
  }
  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override {
    const MutexLock lock(mutex_);
    return status_;
  }
  void on_change(std::function<void()> listener, const void* whose) override {
    const MutexLock lock(telling_mutex_);
    listeners_.erase(whose);
    if (listener) listeners_[whose] = std::move(listener);
  }
  void change(const std::function<void(MachineStatus&)>& how) {
    {
      const MutexLock lock(mutex_);
      auto next = std::make_shared<MachineStatus>(*status_);
      how(*next);
      status_ = std::move(next);
    }
    const MutexLock telling(telling_mutex_);
    for (const auto& [whose, listener] : listeners_) listener();
  }
  void start_job(const std::string& id) {
    change([&id](MachineStatus& status) {
      status.job.emplace();
      status.job->job_id = id;
      status.state = ScanState::kExecuting;
    });
  }
  void end_job(JobState how) {
    change([how](MachineStatus& status) {
      status.job->state = how;
      if (how == JobState::kCompleted) status.completed_job = status.job->job_id;
      status.state = ScanState::kReady;
    });
  }
  [[nodiscard]] std::size_t listeners() {
    const MutexLock lock(telling_mutex_);
    return listeners_.size();
  }

 private:
  mutable Mutex mutex_;
  std::shared_ptr<const MachineStatus> status_ FVD_GUARDED_BY(mutex_);
  Mutex telling_mutex_;
  std::map<const void*, std::function<void()>> listeners_ FVD_GUARDED_BY(telling_mutex_);
};

}  // namespace fvd::test
