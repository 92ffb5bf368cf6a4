#pragma once

/// The documents that readers of events are told, as the methods of the API give them.

#include <chrono>

#include "daemon/api/method.hpp"
#include "daemon/events/topic.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// context: one thread; blocks for nothing but locks that are held for a moment.
class TopicDocuments {
 public:
  /// What services name outlives this.
  explicit TopicDocuments(const Services& services);

  /// Every key of system.state. Another hb alone is no change.
  [[nodiscard]] TopicDocument state(const MachineStatus& machine) const;
  /// Every key of job.status, of the running or the latest job; null before the first. Another age_s alone is no
  /// change, progress alone is not urgent.
  [[nodiscard]] TopicDocument job(const MachineStatus& machine) const;
  /// As control.state tells it to who has it not. Less time alone is no change, a renewal is.
  [[nodiscard]] TopicDocument control() const;
  /// As system.health. Counters and figures alone are not urgent; that a device is there, that the stage stands, is.
  [[nodiscard]] TopicDocument health() const;
  /// The list of alarm.list; none is urgent, for lines of the log come as they like.
  [[nodiscard]] TopicDocument alarms() const;

 private:
  [[nodiscard]] Reply told_by(const std::string& method) const;

  const Services services_;
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  MethodTable methods_;
};

}  // namespace fvd
