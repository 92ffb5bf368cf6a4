#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "drivers/replay/replay_bench.hpp"
#include "drivers/replay/replay_devices.hpp"
#include "drivers/replay/slice_heights.hpp"

namespace fvd {

namespace {

ZSource z_source(const StageConfig& config) {
  if (config.replay_z_file.empty()) return ZSpacing{config.replay_start_um, config.replay_step_um};
  const auto unit = length_unit_from_name(config.replay_z_unit);
  if (!unit) {
    throw Error(ErrorCode::kBadConfig, "stage.replay_z_unit: '" + config.replay_z_unit + "' is not one of: um, mm, m");
  }
  return ZFile{config.replay_z_file, *unit};
}

class ReplayStage final : public Axis {
 public:
  explicit ReplayStage(const StageConfig& config)
      : z_um_(slice_heights_um(z_source(config), find_slices(config.replay_dir))),
        bench_(replay_bench(config.replay_dir)) {
    const auto [low, high] = std::minmax_element(z_um_.begin(), z_um_.end());
    const double half_step = std::abs(z_um_[1] - z_um_[0]) / 2;
    info_.name = "recorded slices";
    info_.address = config.replay_dir.string();
    info_.feedback = FeedbackSource::kLinearScale;
    info_.min = std::max(config.min, Micrometers{*low - half_step});
    info_.max = std::min(config.max, Micrometers{*high + half_step});
    info_.simulated = true;
    bench_->slice = 0;
  }

  [[nodiscard]] StageInfo info() const override { return info_; }

  [[nodiscard]] StageStatus status() override {
    StageStatus status;
    status.enabled = true;
    status.homed = true;
    status.in_position = true;
    status.position = position();
    return status;
  }

  void home(std::stop_token /*stop*/) override {}

  MoveRecord move_to(Micrometers target, const SettleCriterion& criterion, std::stop_token stop) override {
    if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the move was stopped before it began");
    if (!(target >= info_.min && target <= info_.max)) {  // also refuses NaN
      fail(ErrorCode::kStageLimit, target, "is outside the recording or the configured limits");
    }
    const int slice = nearest_slice(z_um_, target.value);
    const Micrometers there{z_um_[static_cast<std::size_t>(slice)]};
    if (abs(there - target) > criterion.window) {
      fail(ErrorCode::kStagePosition, target,
           "has no recorded slice within the settle window of " + std::to_string(criterion.window.value) +
               " um; the nearest is at " + std::to_string(there.value) + " um");
    }
    MoveRecord move;
    move.started = HostClock::now();
    bench_->slice = slice;
    move.target = target;
    move.target_quantised = target;
    move.target_counts = {slice};
    move.position = there;
    move.settled = HostClock::now();
    move.halted = move.settled;
    move.polls = 1;
    return move;
  }

  MoveRecord sweep_to(Micrometers target, double /*speed_um_per_s*/, std::stop_token /*stop*/) override {
    fail(ErrorCode::kStagePosition, target, "cannot be swept to: recorded slices are scanned step by step");
  }

  [[nodiscard]] PositionMean position_at(HostTime /*at*/, std::chrono::microseconds /*reach*/) override {
    return {position(), Micrometers{}, 1};
  }

  [[nodiscard]] PositionMean mean_position(HostTime /*from*/, HostTime /*to*/) override {
    return {position(), Micrometers{}, 1};
  }

  void stop() noexcept override {}
  [[nodiscard]] bool connected() const noexcept override { return true; }

 private:
  [[nodiscard]] Micrometers position() const { return {z_um_[static_cast<std::size_t>(bench_->slice.load())]}; }

  [[noreturn]] void fail(ErrorCode code, Micrometers target, const std::string& problem) const {
    std::ostringstream message;
    message << "target " << target.value << " um " << problem << " (" << z_um_.size() << " slices from "
            << z_um_.front() << " to " << z_um_.back() << " um, travel " << info_.min.value << " to " << info_.max.value
            << " um)";
    throw Error(code, message.str());
  }

  std::vector<double> z_um_;
  std::shared_ptr<ReplayBench> bench_;
  StageInfo info_;
};

}  // namespace

std::unique_ptr<Axis> open_replay_stage(const StageConfig& config) {
  if (config.replay_dir.empty()) {
    throw Error(ErrorCode::kBadConfig, "stage.replay_dir: the driver 'replay' needs the folder of recorded slices");
  }
  return std::make_unique<ReplayStage>(config);
}

}  // namespace fvd
