#include "drivers/common/axis_controller.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/scan/settle_detector.hpp"
#include "drivers/common/alarm_reset.hpp"
#include "drivers/common/axis_poller.hpp"
#include "drivers/common/axis_stopper.hpp"
#include "drivers/common/commanded.hpp"
#include "drivers/common/disable_watch.hpp"
#include "drivers/common/rest_detector.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

/// Maximum age of a sample that is treated as current while the axis rests.
constexpr milliseconds kSampleAge{50};
/// How often a motion is asked for of a drive that says "later"; each time it is looked at first.
constexpr int kBusyAttempts = 6;

class AxisController final : public Axis {
 public:
  AxisController(std::unique_ptr<AxisPort> port, const AxisSettings& settings)
      : settings_(settings),
        port_(std::move(port)),
        traits_(require_limits_inside(port_->traits(), settings)),
        poller_(*port_, settings.limits.speed_um_per_s, settings.min, settings.max),
        stopper_(*port_, poller_, settings.limits) {
    come_to_rest();
  }

  /// An axis is not left moving when nobody watches it any more.
  ~AxisController() override { stopper_.halt_if_moving(); }
  AxisController(const AxisController&) = delete;
  AxisController& operator=(const AxisController&) = delete;

  [[nodiscard]] StageInfo info() const override { return stage_info(traits_, settings_); }

  [[nodiscard]] StageStatus status() override { return status_of(poller_.sample_now({})); }

  [[nodiscard]] std::optional<StageStatus> last_seen() const override {
    const AxisSample sample = poller_.latest();
    disabled_.saw(sample);
    return status_of(sample);
  }

  [[nodiscard]] std::optional<StageLinkStats> link_stats() const override {
    auto stats = port_->link_stats();
    if (stats) stats->implausible = poller_.implausible();
    return stats;
  }

  void reset_alarm(std::stop_token stop) override {
    if (!poller_.sample_after(HostClock::now(), stop).alarm) return;
    // A restart stays noted: the next move is refused for it until the axis is homed.
    if (const auto seen = poller_.foreign_write(true, stop); seen && !seen->is_restart) throw_foreign(traits_, *seen);
    require_profile(stop);
    end_alarm(*port_, poller_, stop);
  }

  void home(std::stop_token stop) override {
    const AxisSample before = poller_.sample_after(HostClock::now(), stop);
    require_homing_possible(*port_, before);
    require_sole_master_since_start(stop);
    prepared_ = false;  // the drive may have been restarted
    make_ready(before, stop);
    require_wanted(stop);
    const Commanded homing(state_, AxisState::kHoming);
    target_.reset();
    poller_.remember_homed(false);
    halting_on_error([&] {
      const CommandResult sent = send_home(before, stop);
      require_wanted(stop);
      require_done(traits_, sent, "home");
      wait_until_homed(HostClock::now(), stop);
    });
  }

  MoveRecord move_to(Micrometers target, const SettleCriterion& criterion, std::stop_token stop) override {
    return move_at(settings_.limits.speed_um_per_s, target, criterion, stop);
  }

  MoveRecord sweep_to(Micrometers target, double speed_um_per_s, std::stop_token stop) override {
    require_sweep_speed(settings_, speed_um_per_s);
    const AxisSample here = current_sample(stop);
    return move_at(speed_um_per_s, target, end_of_sweep(settings_, target - here.position, speed_um_per_s), stop);
  }

  [[nodiscard]] PositionMean mean_position(HostTime from, HostTime to) override {
    require_near(traits_, to);
    (void)poller_.sample_after(to, {});
    return poller_.mean(from, to);
  }

  [[nodiscard]] PositionMean position_at(HostTime at, std::chrono::microseconds reach) override {
    require_near(traits_, at + reach);
    (void)poller_.sample_after(at + reach, {});
    return poller_.line(at, reach);
  }

  void stop() noexcept override {
    disabled_.stopping(poller_.latest());
    (void)stopper_.send();
    changed_ = HostClock::now();
  }

  [[nodiscard]] bool connected() const noexcept override { return poller_.connected(); }

 private:
  /// Whoever set it in motion is gone.
  void come_to_rest() {
    if (stopper_.rests()) return;
    spdlog::warn("the axis at {} was found moving; it is halted", traits_.address);
    const std::string failure = stopper_.halt();
    if (failure.empty()) return;
    throw Error(ErrorCode::kStagePosition, "the axis at " + traits_.address + " was found moving, and " + failure +
                                               "; stop it by its emergency stop");
  }

  /// Nothing is written to a drive that is not what fvd takes it for.
  void require_profile(const std::stop_token& stop) {
    if (!checked_) require_agreement(*port_, stop);
    checked_ = true;
  }

  /// Settings once, and torque where there is none; a drive that has to be enabled may have forgotten its settings.
  void make_ready(const AxisSample& sample, const std::stop_token& stop) {
    if (prepared_ && sample.enabled) return;
    require_profile(stop);
    const CommandResult prepared = port_->prepare(settings_.limits, stop);
    require_wanted(stop);
    require_done(traits_, prepared, "prepare");
    prepared_ = true;
    if (sample.enabled) return;
    const CommandResult enabled = port_->enable(settings_.limits, stop);
    require_wanted(stop);
    require_done(traits_, enabled, "enable");
    disabled_.enabled();
    changed_ = HostClock::now();
  }

  /// look: asks the drive now, instead of trusting the looks that are taken all the time.
  void require_sole_master(bool look, const std::stop_token& stop = {}) {
    const auto foreign = poller_.foreign_write(look, stop);
    if (!foreign) return;
    if (!traits_.tells_homed) poller_.remember_homed(false);  // its memory of the last target is no longer ours
    target_.reset();
    throw_foreign(traits_, *foreign);
  }

  /// A drive that was restarted has lost what was written to it, and nobody else did it.
  void require_sole_master_since_start(const std::stop_token& stop) {
    if (const auto seen = poller_.foreign_write(true, stop); seen && seen->is_restart) poller_.forget_foreign_write();
    require_sole_master(false);
  }

  void require_enabled(const AxisSample& sample) {
    if (!disabled_.somebody_else_disabled(sample)) return;
    poller_.remember_homed(false);
    throw_disabled(traits_);
  }

  /// Drives that do not say whether they are homed forget their last target in a restart.
  void require_reference(const AxisSample& sample, const std::stop_token& stop) {
    if (traits_.tells_homed || !target_) return;
    auto read = sample.target;
    if (!read) read = port_->remembered_target(stop);
    if (!read || *read == *target_) return;
    poller_.remember_homed(false);
    target_.reset();
    throw_forgotten(traits_, "");
  }

  /// The axis rests and is sampled all the time; what happens to it from now on, settle() sees.
  AxisSample current_sample(const std::stop_token& stop) {
    const AxisSample sample = poller_.sample_after(std::max(HostClock::now() - kSampleAge, changed_.load()), stop);
    disabled_.saw(sample);
    return sample;
  }

  [[nodiscard]] StageStatus status_of(const AxisSample& sample) const {
    StageStatus status = stage_status(*port_, sample, poller_.temperatures());
    status.lost_torque = sample.begun >= changed_.load() && disabled_.somebody_else_disabled(sample);
    if (status.lost_torque) status.homed = false;
    status.state = poller_.connected() ? axis_state(sample, state_) : AxisState::kCommLost;
    return status;
  }

  /// Runs a motion. An exception that leaves it first halts the axis; what of that failed is added to its message.
  template <typename Motion>
  void halting_on_error(Motion motion) {
    ErrorCode code = ErrorCode::kInternal;
    std::string message;
    try {
      motion();
      return;
    } catch (const Error& error) {
      code = error.code();
      message = error.what();
      blame_other_master(code, message);
    } catch (const std::exception& error) {
      message = error.what();
    }
    disabled_.stopping(poller_.latest());
    const std::string failure = stopper_.halt();
    changed_ = HostClock::now();
    throw Error(code, failure.empty() ? message : message + "; " + failure);
  }

  /// The axis is yet to be halted: a busy drive is not waited for.
  void blame_other_master(ErrorCode& code, std::string& message) {
    if (!may_be_anothers_doing(code)) return;
    std::stop_source impatient;
    impatient.request_stop();
    try {
      require_sole_master(true, impatient.get_token());
    } catch (const Error& error) {
      code = error.code();
      message += std::string("; ") + error.what();
    }
  }

  /// A drive that was busy may have begun all the same: it is looked at before it is asked again.
  CommandResult send_home(const AxisSample& before, const std::stop_token& stop) {
    const auto homes = [&](const AxisSample& sample) {
      return sample.moving || (before.homed && traits_.tells_homed && !sample.homed);
    };
    CommandResult result = port_->home(settings_.limits, stop);
    for (int attempt = 1; result.later && attempt < kBusyAttempts && !stop.stop_requested(); ++attempt) {
      spdlog::warn("the drive at {} puts off its homing: {}", traits_.address, result.error);
      const bool resumes = result.repeatable || seen_to(homes, stop);
      result = resumes ? port_->resume(stop) : port_->home(settings_.limits, stop);
    }
    return result;
  }

  void wait_until_homed(HostTime started, const std::stop_token& stop) {
    bool moved = false;
    RestDetector rest(rest_window(traits_.feedback_resolution));
    for (HostTime last = HostClock::now();;) {
      const AxisSample sample = poller_.sample_after(last, stop);
      last = sample.begun;
      require_homing_possible(*port_, sample);
      moved = moved || sample.moving || (traits_.tells_homed && !sample.homed);
      // An axis that was homed and rests at its origin never shows motion: then the start time decides.
      const bool begun = moved || sample.time - started > traits_.start_within;
      if (!begun || (traits_.tells_homed && !sample.homed)) {
        rest.reset();
      } else if (rest.add(sample.time, sample.position, !sample.moving)) {
        poller_.remember_homed(true);
        changed_ = HostClock::now();
        return;
      }
      if (sample.time - started > traits_.home_timeout) {
        throw_not_homed_in_time(traits_);
      }
    }
  }

  MoveRecord move_at(double speed_um_per_s, Micrometers target, const SettleCriterion& criterion,
                     std::stop_token stop) {
    MoveRecord move;
    move.target = target;
    move.target_counts = quantise(traits_, target);
    move.target_quantised = Micrometers{move.target_counts.value / traits_.steps_per_um};
    require_within_limits(settings_, move.target_quantised);
    const AxisSample before = current_sample(stop);
    require_no_alarm(*port_, before);
    require_off_limits(traits_, before);
    require_sole_master(true, stop);  // the move would write over what another one left
    require_enabled(before);
    require_homed(traits_, before);
    make_ready(before, stop);  // disabled by our own stop: this is a new command
    require_reference(before, stop);
    require_wanted(stop);
    const Commanded moving(state_, AxisState::kMoving);
    move.started = HostClock::now();
    halting_on_error([&] {
      start_move(move, {speed_um_per_s, settings_.limits.acceleration_um_per_s2}, before, criterion, stop);
      settle(move, before, criterion, stop);
    });
    return move;
  }

  /// Sends the move. What had no usable answer and does no harm twice is sent again, and the rest after it; after
  /// anything else it looks whether the axis obeys, and only if it does not, sends the same absolute target once more:
  /// an absolute move that did arrive is not repeated by that.
  void start_move(const MoveRecord& move, const MotionLimits& limits, const AxisSample& before,
                  const SettleCriterion& criterion, const std::stop_token& stop) {
    const auto before_target = target_;
    const auto moves = [&](const AxisSample& sample) { return obeys(sample, move, before, criterion); };
    bool resumes = false;
    bool has_begun = false;
    for (int attempt = 1;; ++attempt) {
      CommandResult result;
      poller_.pause([&] { result = resumes ? port_->resume(stop) : port_->move(move.target_counts, limits, stop); });
      target_ = move.target_counts.value;
      if (result.outcome == CommandOutcome::kDone) return;
      const bool refused = result.outcome == CommandOutcome::kRefused;
      if (refused && has_begun) return spdlog::warn("the start of a move could not be completed: {}", result.error);
      if (refused && port_->remembered_target(stop) != target_) target_ = before_target;
      require_wanted(stop);
      if (refused) {
        require_sound(poller_.sample_after(HostClock::now(), stop), false);  // which says why, if the drive does
        throw Error(ErrorCode::kStagePosition,
                    "the drive at " + traits_.address + " refused the move: " + result.error);
      }
      spdlog::warn("no answer to a move to {} um: {}", move.target.value, result.error);
      const bool begins = !result.repeatable && seen_to(moves, stop);
      has_begun = has_begun || begins;
      resumes = result.repeatable || begins;
      if (attempt >= (result.later || begins ? kBusyAttempts : 2)) {
        throw Error(ErrorCode::kStageDisconnected,
                    "the drive at " + traits_.address + " answers no move command: " + result.error);
      }
    }
  }

  /// Looks whether the axis does so, for as long as it may take to begin.
  template <typename Does>
  bool seen_to(const Does& does, const std::stop_token& stop) {
    const HostTime started = HostClock::now();
    for (HostTime last = started;;) {
      const AxisSample sample = poller_.sample_after(last, stop);
      last = sample.begun;
      if (does(sample)) return true;
      if (sample.time - started > traits_.start_within) return false;
    }
  }

  /// What must hold of every sample of a move.
  void require_sound(const AxisSample& sample, bool begun) {
    require_no_alarm(*port_, sample);
    require_off_limits(traits_, sample);
    require_enabled(sample);
    if (begun && sample.target) require_reference(sample, {});
    require_reference_kept(traits_, sample);
    require_sole_master(false);
  }

  void settle(MoveRecord& move, const AxisSample& before, const SettleCriterion& criterion,
              const std::stop_token& stop) {
    SettleDetector detector(move.target_quantised, criterion);
    bool begun = false;
    // Only samples taken after the command count: the drive's "in position" of the move before is stale.
    const HostTime commanded = HostClock::now();  // the last attempt, which move.started may lie well before
    for (HostTime last = commanded;;) {
      const AxisSample sample = poller_.sample_after(last, stop);
      last = sample.begun;
      ++move.polls;
      require_sound(sample, begun);
      begun = begun || obeys(sample, move, before, criterion);
      if (sample.moving || !begun) {
        move.halted = {};
      } else if (move.halted == HostTime{}) {
        move.halted = sample.time;
      }
      if (!begun && sample.time - commanded > traits_.start_within) {
        throw_not_begun(traits_, move.target);
      }
      if (detector.add(sample.time, sample.position, !sample.moving && sample.in_position)) {
        move.position = sample.position;
        move.settled = HostClock::now();
        return;
      }
      if (sample.time - move.started > criterion.timeout) {
        throw Error(ErrorCode::kStagePosition, not_settled_text(move, sample, criterion));
      }
    }
  }

  const AxisSettings settings_;
  const std::unique_ptr<AxisPort> port_;
  const AxisTraits& traits_;
  std::atomic<AxisState> state_{AxisState::kReady};
  mutable DisableWatch disabled_;
  std::atomic<HostTime> changed_{HostTime{}};  // by fvd: older samples do not tell what the drive is like now
  bool checked_ = false;                       // the mover's thread only, as the next
  bool prepared_ = false;
  std::optional<std::int64_t> target_;  // steps, last one sent since homing
  AxisPoller poller_;
  AxisStopper stopper_;
};

}  // namespace

std::unique_ptr<Axis> make_axis(std::unique_ptr<AxisPort> port, const AxisSettings& settings) {
  return std::make_unique<AxisController>(std::move(port), settings);
}

}  // namespace fvd
