#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "drivers/replay/recorded_stack.hpp"
#include "drivers/replay/replay_bench.hpp"
#include "drivers/replay/replay_devices.hpp"

namespace fvd {

namespace {

/// Fixed number of slices in memory; a frame lends one and gives it back from any thread.
class ReplayPool final : public FrameRecycler {
 public:
  explicit ReplayPool(int frames) : slots_(static_cast<std::size_t>(frames)) {
    for (SliceImage& slot : slots_) free_.push_back(&slot);
  }

  /// Nothing while all are lent.
  [[nodiscard]] SliceImage* borrow() {
    const MutexLock lock(mutex_);
    if (free_.empty()) return nullptr;
    SliceImage* slot = free_.back();
    free_.pop_back();
    return slot;
  }

  void recycle(void* slot) noexcept override {
    const MutexLock lock(mutex_);
    free_.push_back(static_cast<SliceImage*>(slot));  // never above the capacity it had when all were free
  }

  [[nodiscard]] int frames() const noexcept { return static_cast<int>(slots_.size()); }

 private:
  std::vector<SliceImage> slots_;
  Mutex mutex_;
  std::vector<SliceImage*> free_ FVD_GUARDED_BY(mutex_);
};

class ReplayCamera final : public Camera {
 public:
  explicit ReplayCamera(const CameraConfig& config)
      : stack_(config.replay_dir), bench_(replay_bench(config.replay_dir)), address_(config.replay_dir.string()) {}

  [[nodiscard]] CameraInfo info() const override {
    return {.vendor = "fvd",
            .model = "recorded slices " + stack_.list().description,
            .serial = {},
            .firmware = {},
            .address = address_,
            .sensor_width = stack_.width(),
            .sensor_height = stack_.height(),
            .simulated = true};
  }

  CameraSettings configure(const CameraSettings& settings) override {
    const auto fits = [](int asked, int there) { return asked == 0 || asked == there; };
    if (!fits(settings.width, stack_.width()) || !fits(settings.height, stack_.height()) || settings.offset_x != 0 ||
        settings.offset_y != 0 || settings.slice_format() != stack_.format()) {
      throw Error(ErrorCode::kCameraSettings,
                  "recorded slices are delivered as they are: " + std::to_string(stack_.width()) + " x " +
                      std::to_string(stack_.height()) + " pixels of " +
                      std::to_string(significant_bits(stack_.format())) + " bit, offset 0; asked for were " +
                      std::to_string(settings.width) + " x " + std::to_string(settings.height) + " of " +
                      std::to_string(significant_bits(settings.slice_format())) + " bit, offset " +
                      std::to_string(settings.offset_x) + ", " + std::to_string(settings.offset_y));
    }
    if (settings.pool_frames < 1) {
      throw Error(ErrorCode::kCameraSettings,
                  "a pool of " + std::to_string(settings.pool_frames) + " frames: at least 1 is needed");
    }
    if (!pool_ || pool_->frames() != settings.pool_frames) {
      pending_.clear();  // their leases point into the old pool
      pool_ = std::make_unique<ReplayPool>(settings.pool_frames);
    }
    {
      const MutexLock lock(mutex_);
      interrupted_ = false;  // that was for a wait of before
    }
    CameraSettings in_force = settings;
    in_force.width = stack_.width();
    in_force.height = stack_.height();
    return in_force;
  }

  void trigger() override {
    if (!pool_) throw Error(ErrorCode::kCameraSettings, "the camera was triggered before it was configured");
    SliceImage* slot = pool_->borrow();
    if (slot == nullptr) {
      ++health_.underruns;
      return;
    }
    Frame frame;
    frame.lease = FrameLease(slot, FrameSlotDeleter{pool_.get()});
    frame.exposure_start = HostClock::now();
    stack_.read(bench_->slice.load(), *slot);
    frame.status = FrameStatus::kOk;
    frame.image = slot->view();
    frame.id = ++last_id_;
    frame.exposure_end = frame.exposure_start;
    ++health_.frames_complete;
    pending_.push_back(std::move(frame));
  }

  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    if (pending_.empty()) {
      // Frames arrive inside trigger(), on this thread: all there is to wait for is the deadline or an interrupt.
      MutexLock lock(mutex_);
      interrupted_changed_.wait_until(lock, deadline, [this] {
        mutex_.assert_held();
        return interrupted_;
      });
      interrupted_ = false;
      return std::nullopt;
    }
    std::optional<Frame> frame(std::move(pending_.front()));
    pending_.pop_front();
    return frame;
  }

  [[nodiscard]] std::chrono::microseconds frame_deadline() const override { return std::chrono::milliseconds(100); }

  void interrupt() noexcept override {
    {
      const MutexLock lock(mutex_);
      interrupted_ = true;
    }
    interrupted_changed_.notify_all();
  }

  [[nodiscard]] bool connected() const noexcept override { return true; }
  [[nodiscard]] CameraHealth health() const override { return health_; }

 private:
  RecordedStack stack_;
  std::shared_ptr<ReplayBench> bench_;
  std::string address_;
  CameraHealth health_;
  std::uint64_t last_id_ = 0;
  Mutex mutex_;
  Condition interrupted_changed_;
  bool interrupted_ FVD_GUARDED_BY(mutex_) = false;
  std::unique_ptr<ReplayPool> pool_;
  std::deque<Frame> pending_;  // after the pool: its leases go back before the pool dies
};

}  // namespace

std::unique_ptr<Camera> open_replay_camera(const CameraConfig& config) {
  if (config.replay_dir.empty()) {
    throw Error(ErrorCode::kBadConfig, "camera.replay_dir: the driver 'replay' needs the folder of recorded slices");
  }
  return std::make_unique<ReplayCamera>(config);
}

}  // namespace fvd
