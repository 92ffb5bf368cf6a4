#pragma once

/// Commands to the devices between two jobs: images, exposure, focus, moves.

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "daemon/config/config.hpp"
#include "daemon/devices/device_hub.hpp"
#include "daemon/export/preview_hub.hpp"
#include "daemon/jobs/machine_board.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/jobs/work_queue.hpp"
#include "daemon/store/stage_history.hpp"

namespace fvd {

/// One command at a time. Every command that was taken is answered, whatever happens.
/// context: thread-safe; the commands run on the machine's thread.
class TaskRunner final : public TaskService, public PictureSource {
 public:
  struct Dependencies {
    MachineBoard& board;
    DeviceHub& hub;
    WorkQueue& work;
    Clock& clock;
    PreviewHub& preview;
    const StageHistory& history;
    std::filesystem::path state_dir;
    const std::vector<ObjectiveConfig>& objectives;  ///< of the configuration
  };
  explicit TaskRunner(Dependencies dependencies) : deps_(std::move(dependencies)) {}

  std::shared_ptr<DeviceTask> submit(DeviceTask::Work work, TaskMotion motion, HostTime asked) override;
  std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) override;
  void jog(const JogRequest& request) override;
  [[nodiscard]] bool extend_jog(const JogRequest& request) override;
  [[nodiscard]] std::optional<StepHistorySummary> stage_history() const override;
  [[nodiscard]] std::shared_ptr<const PreviewPicture> newest_picture() override;

  /// Ends the command that was taken last, if it still waits or runs. May be called inside MachineBoard::update().
  [[nodiscard]] std::stop_source task_stop();

 private:
  void post(const std::shared_ptr<DeviceTask>& task, HostTime asked);
  void run(DeviceTask& task, const std::stop_token& stop);
  void refuse(DeviceTask& task);
  [[nodiscard]] std::shared_ptr<JogHold> last_jog();
  [[nodiscard]] DeviceTask::Outcome performed(const DeviceTask& task, const std::stop_token& stop) const;

  const Dependencies deps_;
  Mutex mutex_;
  std::stop_source stop_ FVD_GUARDED_BY(mutex_);         // of the command taken last
  std::shared_ptr<JogHold> jog_ FVD_GUARDED_BY(mutex_);  // the last one; null before the first
};

}  // namespace fvd
