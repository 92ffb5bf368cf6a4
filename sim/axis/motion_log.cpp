#include "sim/axis/motion_log.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace fvd::sim {

namespace {

constexpr std::chrono::milliseconds kPeriod{1};

}  // namespace

MotionLog::MotionLog(AxisModel& axis, const std::filesystem::path& file)
    : axis_(axis), out_(std::fopen(file.c_str(), "we")) {
  {
    const MutexLock lock(mutex_);
    if (!out_) throw Error(ErrorCode::kStorageWrite, "cannot write the motion log " + file.string());
    (void)std::setvbuf(out_.get(), nullptr, _IOLBF, BUFSIZ);  // readers see whole lines at once
  }
  axis_.watch_commands([this](HostTime at, const std::string& command) { add(at, command); });
  thread_ = start_thread("motion-log", [this](const std::stop_token& stop) { watch(stop); });
}

MotionLog::~MotionLog() { axis_.watch_commands({}); }

void MotionLog::add(HostTime at, const std::string& what) {
  const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(at.time_since_epoch()).count();
  const MutexLock lock(mutex_);
  (void)std::fprintf(out_.get(), "%lld %s\n", static_cast<long long>(ns), what.c_str());
}

void MotionLog::watch(const std::stop_token& stop) {
  HostTime before = HostClock::now();
  double position_um = axis_.true_position_um(before);
  bool was_moving = false;
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(kPeriod);
    const HostTime now = HostClock::now();
    const double here_um = axis_.true_position_um(now);
    const double speed_um_per_s = std::abs(here_um - position_um) / std::chrono::duration<double>(now - before).count();
    const bool moving = speed_um_per_s > kMovingSpeed_um_per_s;
    // What a busy machine makes longer than a period counts as motion as a whole.
    if (moving != was_moving) add(before, moving ? "moving" : "still");
    was_moving = moving;
    before = now;
    position_um = here_um;
  }
}

}  // namespace fvd::sim
