#include "daemon/jobs/control_lease.hpp"

#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/access/access_error.hpp"

namespace fvd {

namespace {

std::string text_of(const ControlLease::Holder& holder) { return "'" + holder.owner + "' (" + holder.who + ")"; }

}  // namespace

ControlLease::ControlLease(std::function<HostTime()> now, std::function<bool()> job_runs)
    : now_(std::move(now)), job_runs_(std::move(job_runs)) {}

ControlLease::Holder ControlLease::acquire(const Request& request) {
  Holder holder = take(request, job_runs_());  // not under the lock
  tell();
  return holder;
}

ControlLease::Holder ControlLease::take(const Request& request, bool job_runs) {
  const Holder wanted{request.who.name, request.owner, now_() + request.time};
  const MutexLock lock(mutex_);
  const auto before = holder_locked(job_runs);
  if (before && before->who != wanted.who) {
    if (!request.force) {
      throw AccessError(AccessCode::kNoControl,
                        text_of(*before) + " has control; wait, or have who administers take it");
    }
    if (request.who.role < Role::kAdminister) {
      throw AccessError(AccessCode::kNotAllowed, "only who administers may take control from " + text_of(*before));
    }
    if (job_runs) {
      throw Error(ErrorCode::kBusy, "a job runs, and " + text_of(*before) + " has control: nobody takes it meanwhile");
    }
    spdlog::warn("control is taken from {} by {}", text_of(*before), text_of(wanted));
  } else if (!before) {
    // Who started it goes on without control: he is asked for none until somebody has it.
    if (job_runs) throw Error(ErrorCode::kBusy, "a job runs that was started without control: wait for its end");
    spdlog::info("{} has control", text_of(wanted));
  }
  holder_ = wanted;
  return wanted;
}

void ControlLease::release(const std::string& who) {
  {
    const MutexLock lock(mutex_);
    if (!holder_ || holder_->who != who) return;
    spdlog::info("{} gives control up", text_of(*holder_));
    holder_.reset();
  }
  tell();
}

void ControlLease::on_change(std::function<void()> listener) {
  const MutexLock lock(telling_mutex_);
  listener_ = std::move(listener);
}

void ControlLease::tell() {
  const MutexLock lock(telling_mutex_);
  if (listener_) listener_();
}

void ControlLease::require(const std::string& who) const {
  const auto now = holder();
  if (!now || now->who == who) return;
  throw AccessError(AccessCode::kNoControl, text_of(*now) + " has control; see control.acquire");
}

std::optional<ControlLease::Holder> ControlLease::holder() const {
  const bool job_runs = job_runs_();  // not under the lock
  const MutexLock lock(mutex_);
  return holder_locked(job_runs);
}

std::optional<ControlLease::Holder> ControlLease::holder_locked(bool job_runs) const {
  if (!holder_ || (now_() >= holder_->until && !job_runs)) return std::nullopt;
  return holder_;
}

}  // namespace fvd
