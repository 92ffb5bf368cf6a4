#pragma once

/// What is known of the machine: changed in one place, read by everybody without waiting.

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "daemon/devices/device_hub.hpp"
#include "daemon/jobs/machine_state.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/store/job_status.hpp"
#include "daemon/store/sequence_numbers.hpp"
#include "daemon/store/storage_watch.hpp"

namespace fvd {

struct MachineRecord {
  MachineState state;
  std::string recipe;                     ///< prepared recipe, empty = none
  std::optional<JobStatus> job;           ///< the running or the latest job
  std::optional<DeviceFailure> failure;   ///< why the devices cannot be used
  std::optional<DeviceFailure> alarm;     ///< of the drive
  std::optional<StorageProblem> storage;  ///< why results cannot be kept
  std::optional<DeviceFacts> devices;     ///< of the devices when they were opened last
  std::string objective;                  ///< that was confirmed, empty = none
  DevicesHealth health{};                 ///< at the last look
  std::optional<DiskSpace> disk{};        ///< likewise
  bool confirming = false;                ///< another one is being made durable: nothing that rests on it begins

  /// Ignores an event that its table does not allow.
  void apply(MachineEvent event);
  /// DevicesDown for the reason, or DevicesUp for nothing.
  void set_devices(const std::optional<DeviceFailure>& why_not);
  /// AlarmSeen for the alarm, or AlarmGone for nothing.
  void set_alarm(const std::optional<DeviceFailure>& seen);
  /// StorageBad for the reason, or StorageGood for nothing.
  void set_storage(const std::optional<StorageProblem>& why_not);
  /// Throws Error kShuttingDown, kBusy, kNotReady, and of a problem of the storage.
  void require(Command command) const;
  /// That the objective may be another one from now on. Throws Error kShuttingDown; kBusy while a job is accepted or
  /// runs, while a command has the devices, while another confirmation is made durable.
  void require_objective_unused() const;
};

/// context: thread-safe. A reader waits for the copy of a pointer alone. The log is written, and the listeners called,
/// under a lock that no reader needs; no lock is held over a database or a device.
class MachineBoard final : public MachineView {
 public:
  struct Constants {
    bool simulated = false;  ///< whatever the devices say of themselves
    std::int64_t epoch = 0;
    std::function<int()> results_waiting;  ///< must not block, as the next two
    std::function<int()> results_valid{};  ///< the completed ones among them
    std::function<std::shared_ptr<const NewestSeqs>()> newest_seqs{};
    int fifo_results = 1000;                 ///< more that wait are an overrun
    std::function<bool()> axis_stands = {};  ///< as DeviceHub::seen_standing(); empty = whenever it is measured
    std::uint64_t jobs_interrupted = 0;      ///< see JobCounts
  };
  MachineBoard(Constants constants, std::optional<JobStatus> latest_job);

  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override;
  [[nodiscard]] bool stage_stands() const override;
  void on_change(std::function<void()> listener, const void* whose = nullptr) override;

  [[nodiscard]] MachineRecord read() const;

  /// Changes the record in one piece: readers see the whole change or nothing of it, and nothing if it throws. Then
  /// logs what changed for clients and tells the listeners. change: short, calls nothing of the board, takes no lock
  /// that is held while the board is called.
  void update(const std::function<void(MachineRecord&)>& change);

  /// From now on nothing that was asked for before begins. The caller reads the record afterwards, and ends what has
  /// begun by then.
  void note_stop() noexcept { last_stop_ = HostClock::now(); }
  /// When motion was stopped last.
  [[nodiscard]] HostTime last_stop() const noexcept { return last_stop_; }
  /// For the change that begins a motion, inside update(): no stop is lost between this and its beginning. Throws Error
  /// kAborted if motion was stopped after that time; no time was asked at = never.
  void require_unstopped(HostTime asked) const;

 private:
  void publish_locked() FVD_REQUIRES(mutex_);
  void tell();

  const Constants constants_;
  std::atomic<HostTime> last_stop_{HostTime{}};

  mutable Mutex mutex_;
  MachineRecord record_ FVD_GUARDED_BY(mutex_);
  JobCounts ended_ FVD_GUARDED_BY(mutex_);
  std::string completed_job_ FVD_GUARDED_BY(mutex_);        ///< the latest
  std::vector<std::string> untold_ FVD_GUARDED_BY(mutex_);  ///< changes that the log lacks, in their order

  mutable Mutex status_mutex_;  // held for a pointer's copy alone, inside mutex_ or without it
  std::shared_ptr<const MachineStatus> status_ FVD_GUARDED_BY(status_mutex_);

  Mutex telling_mutex_;  // held while listeners run: once on_change({}) returned, that one is not called again
  std::map<const void*, std::function<void()>> listeners_ FVD_GUARDED_BY(telling_mutex_);
};

}  // namespace fvd
