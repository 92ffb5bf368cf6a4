#pragma once

/// Watches the machine and tells, as numbered events, which of its documents changed.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "daemon/events/event_ring.hpp"
#include "daemon/events/topic.hpp"
#include "daemon/events/topic_documents.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// Since the start.
struct EventCounts {
  std::uint64_t told = 0;     ///< events
  std::uint64_t dropped = 0;  ///< events that readers were too slow for, of all readers
  std::uint64_t resyncs = 0;  ///< readers that were told everything anew
};

/// Owns one thread, which makes the documents; whoever changes something only wakes it. A reader has a place, the
/// number of the last event that it was given, and nothing is kept for it: what the ring no longer has it is told by a
/// snapshot. Events: state, job, control, health, alarms with the whole document; result with the id of a job that
/// completed. context: thread-safe.
class EventHub {
 public:
  /// Becomes a listener of the machine and of control. What services name outlives it.
  explicit EventHub(const Services& services);
  ~EventHub();
  EventHub(const EventHub&) = delete;
  EventHub& operator=(const EventHub&) = delete;

  /// Something changed that is told of: it is looked at within 20 ms, alarms within 250 ms and once a second. Returns
  /// at once.
  void look_again();

  /// What a reader is given next, and where it is then.
  struct Told {
    std::string text;
    std::uint64_t place = 0;
  };
  /// The beginning. last_event_id: of the last event that the reader was given, by this stream or one before; where it
  /// is in the ring the reader goes on from there, else everything is told anew.
  [[nodiscard]] Told begin(const std::optional<std::string>& last_event_id);
  /// What came after; empty text: nothing.
  [[nodiscard]] Told after(std::uint64_t place);

  /// listener: called, from any thread, after new events; returns at once. One for each `whose`; an empty one ends it:
  /// after the return it is not called again.
  void on_events(std::function<void()> listener, const void* whose);

  [[nodiscard]] EventCounts counts() const;

 private:
  enum TopicIndex : std::size_t { kState, kJob, kControl, kHealth, kAlarms, kTopics };
  static constexpr std::array<std::string_view, kTopics> kNames{"state", "job", "control", "health", "alarms"};

  void run(const std::stop_token& stop);
  /// Makes the documents and tells what changed.
  void look();
  /// The machine's listener.
  void note_change();
  [[nodiscard]] std::string snapshot() FVD_REQUIRES(mutex_);
  [[nodiscard]] Told everything_anew() FVD_REQUIRES(mutex_);

  const Services services_;
  const TopicDocuments documents_;
  // Of the list of alarms, the revision that was looked at, and whether it waits to be told. The thread's, before it
  // the constructor's.
  std::optional<std::uint64_t> seen_alarms_;
  bool owes_alarms_ = false;

  mutable Mutex mutex_;
  Condition changed_;
  bool is_woken_ FVD_GUARDED_BY(mutex_) = false;
  std::array<Topic, kTopics> topics_ FVD_GUARDED_BY(mutex_);
  EventRing ring_ FVD_GUARDED_BY(mutex_);
  std::string known_result_ FVD_GUARDED_BY(mutex_);  ///< job whose completion is told, or was before the start
  std::vector<std::string> new_results_ FVD_GUARDED_BY(mutex_);
  EventCounts counts_ FVD_GUARDED_BY(mutex_);

  Mutex telling_mutex_;  // held while listeners run
  std::map<const void*, std::function<void()>> listeners_ FVD_GUARDED_BY(telling_mutex_);

  std::jthread thread_;  // last
};

}  // namespace fvd
