#pragma once

/// Who has control of the instrument: one at a time, for a time.

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "daemon/access/role.hpp"

namespace fvd {

/// While nobody holds it, everybody may do what his role says. It belongs to an identity, not to a connection: a PLC
/// that lost its connection still has control when it is back.
/// context: thread-safe; blocks for nothing.
class ControlLease {
 public:
  struct Holder {
    std::string who;    ///< the identity
    std::string owner;  ///< what it calls itself, for people
    HostTime until{};
  };
  struct Request {
    const Identity& who;
    std::string owner;
    std::chrono::seconds time{0};
    bool force = false;  ///< take it from another
  };

  /// job_runs: whether a job runs now; blocks for nothing. While one does, nobody's time is over.
  ControlLease(std::function<HostTime()> now, std::function<bool()> job_runs);

  /// From now on for the time given; the holder itself renews it so. Throws AccessError kNoControl where another holds
  /// it and force is not set, kNotAllowed where it is set by one who does not administer; Error kBusy where it is set
  /// while a job runs, or where nobody has it meanwhile.
  Holder acquire(const Request& request);
  /// No effect where the identity does not hold it.
  void release(const std::string& who);
  /// Throws AccessError kNoControl where another holds it.
  void require(const std::string& who) const;
  /// Nothing where nobody holds it, or his time is over.
  [[nodiscard]] std::optional<Holder> holder() const;

  /// Called after control was taken, renewed or given up, from any thread; returns at once. Nobody tells that the time
  /// is over. An empty one ends it: after the return the one before is not called again.
  void on_change(std::function<void()> listener);

 private:
  Holder take(const Request& request, bool job_runs);
  [[nodiscard]] std::optional<Holder> holder_locked(bool job_runs) const FVD_REQUIRES(mutex_);
  void tell();

  const std::function<HostTime()> now_;
  const std::function<bool()> job_runs_;
  mutable Mutex mutex_;
  std::optional<Holder> holder_ FVD_GUARDED_BY(mutex_);
  Mutex telling_mutex_;  // held while the listener runs
  std::function<void()> listener_ FVD_GUARDED_BY(telling_mutex_);
};

}  // namespace fvd
