#pragma once

/// A motion that goes on only while somebody says so.

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "daemon/jobs/device_task.hpp"

namespace fvd {

struct JogRequest {
  bool up = true;               ///< towards greater z
  double speed_um_per_s = 0.0;  ///< above 0, at most the stage's
  HostTime until{};             ///< when it ends unless it is repeated
  std::string who;              ///< asks for it
  HostTime asked{};             ///< when the request came

  /// The same motion of the same caller.
  [[nodiscard]] bool repeats(const JogRequest& other) const {
    return up == other.up && speed_um_per_s == other.speed_um_per_s && who == other.who;
  }
};

/// How long a jog goes on. context: thread-safe; extend() and failure() block for nothing.
class JogHold {
 public:
  explicit JogHold(JogRequest request) : request_(std::move(request)), until_(request_.until) {}

  [[nodiscard]] const JogRequest& request() const noexcept { return request_; }
  /// True if the jog goes on until the request's time. Another motion, or another caller's, ends it: false.
  [[nodiscard]] bool extend(const JogRequest& request);
  /// Waits until its time is over, which cannot be changed from then on, or until stop is requested.
  void wait_until_over(std::stop_token stop);

  /// The jog failed.
  void fail(ErrorCode code, const std::string& message);
  /// Why it failed, once, to who repeats it within a second. That it was stopped: to every further jog of its caller,
  /// until none comes for 500 ms.
  [[nodiscard]] std::optional<Error> take_failure(const JogRequest& repeat);

 private:
  const JogRequest request_;
  Mutex mutex_;
  Condition changed_;
  HostTime until_ FVD_GUARDED_BY(mutex_);
  bool over_ FVD_GUARDED_BY(mutex_) = false;
  std::optional<Error> failure_ FVD_GUARDED_BY(mutex_);
  HostTime failed_ FVD_GUARDED_BY(mutex_){};
  HostTime refused_ FVD_GUARDED_BY(mutex_){};  ///< when its failure was told last
};

/// Moves towards the soft limit, of the objective where one is confirmed, and halts when the hold is over. Why it
/// failed, or could not begin, is kept in the hold, for nobody waits for this task.
[[nodiscard]] std::shared_ptr<DeviceTask> jog_task(const std::shared_ptr<JogHold>& hold);

}  // namespace fvd
