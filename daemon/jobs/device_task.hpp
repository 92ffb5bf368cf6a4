#pragma once

/// A command to the devices between two jobs: an image, an autofocus, a move.

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "daemon/config/config.hpp"

namespace fvd {

class PreviewHub;

struct Devices {
  Camera& camera;
  Axis& stage;
  Clock& clock;
  std::filesystem::path state_dir;
  const ObjectiveConfig* objective = nullptr;  ///< that was confirmed, and does not change meanwhile; nullptr = none
  PreviewHub* pictures = nullptr;              ///< gets the images that are taken, for who looks on; nullptr = nobody
};

/// What a command does to the axis: a part may not be touched while a command moves it.
enum class TaskMotion { kNone, kMoves };

/// context: perform() and run() on the machine's thread, the rest on any.
class DeviceTask {
 public:
  /// Returns the result as a JSON text. A stop request ends it: a job has come, or the daemon goes.
  using Work = std::function<std::string(const Devices& devices, std::stop_token stop)>;

  struct Outcome {
    std::string json;
    std::optional<ErrorCode> error;
    std::string message;
  };

  /// when_ended: called once with the answer, before anybody else sees it; must not throw.
  explicit DeviceTask(Work work, TaskMotion motion = TaskMotion::kNone,
                      std::function<void(const Outcome&)> when_ended = {})
      : work_(std::move(work)), motion_(motion), when_ended_(std::move(when_ended)) {}
  /// A task that is done already.
  explicit DeviceTask(Outcome outcome) : outcome_(std::move(outcome)) {}

  /// Does the work and tells nobody yet: the machine's state comes before the answer.
  [[nodiscard]] Outcome perform(const Devices& devices, std::stop_token stop) const noexcept;
  /// Tells when_ended what the answer will be: while the devices are not free yet.
  void foretell(const Outcome& outcome) noexcept;
  /// Calls `look` once with the answer, at once where it is there, else before outcome() gives it. It must not throw,
  /// nor ask this task.
  void note_outcome(std::function<void(const Outcome&)> look);
  /// Gives the answer; only the first call counts.
  void end(Outcome outcome) noexcept;
  /// perform() and end().
  void run(const Devices& devices, std::stop_token stop) noexcept;
  void fail(ErrorCode code, const std::string& message) noexcept;

  /// Nothing until the task is done.
  [[nodiscard]] std::optional<Outcome> outcome() const;
  [[nodiscard]] bool moves() const noexcept { return motion_ == TaskMotion::kMoves; }

 private:
  Work work_;
  TaskMotion motion_ = TaskMotion::kNone;
  mutable Mutex mutex_;
  std::function<void(const Outcome&)> when_ended_ FVD_GUARDED_BY(mutex_);
  std::function<void(const Outcome&)> look_ FVD_GUARDED_BY(mutex_);
  std::optional<Outcome> outcome_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
