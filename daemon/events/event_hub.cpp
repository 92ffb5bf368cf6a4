#include "daemon/events/event_hub.hpp"

#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

/// Between two looks: what changes in bursts is told once.
constexpr std::chrono::milliseconds kBetweenLooks{20};
/// Without a change: what tells nobody that it changed (control that ends by itself, a thread that hangs) is seen then.
constexpr std::chrono::milliseconds kLongestBetweenLooks{250};
constexpr std::chrono::milliseconds kJobPatience{100};
constexpr std::chrono::milliseconds kHealthPatience{2000};
constexpr std::chrono::milliseconds kAlarmPatience{1000};  // the whole list each time
constexpr std::chrono::milliseconds kNoPatience{0};
constexpr std::chrono::seconds kLongestLook{10};
constexpr std::size_t kMostAtOnce_bytes = std::size_t{64} << 10U;
constexpr std::size_t kMostNewResults = 64;
constexpr std::string_view kRetry = "retry: 2000\n\n";  // ms, after which a browser connects again

}  // namespace

EventHub::EventHub(const Services& services)
    : services_(services),
      documents_(services),
      topics_{Topic(kNoPatience), Topic(kJobPatience), Topic(kNoPatience), Topic(kHealthPatience),
              Topic(kAlarmPatience)},
      ring_(services.machine.snapshot()->epoch) {
  {
    const MutexLock lock(mutex_);
    known_result_ = services_.machine.snapshot()->completed_job;
  }
  look();
  services_.machine.on_change([this] { note_change(); }, this);
  services_.control.on_change([this] { look_again(); });
  thread_ = start_thread("fvd-events", [this](const std::stop_token& stop) { run(stop); });
}

EventHub::~EventHub() {
  services_.machine.on_change({}, this);
  services_.control.on_change({});
  thread_.request_stop();
  thread_.join();
}

void EventHub::look_again() {
  {
    const MutexLock lock(mutex_);
    is_woken_ = true;
  }
  changed_.notify_one();
}

void EventHub::note_change() {
  // Here and not where it is looked at: by then the next job may have completed.
  std::string completed = services_.machine.snapshot()->completed_job;
  {
    const MutexLock lock(mutex_);
    if (!completed.empty() && completed != known_result_) {
      known_result_ = completed;
      if (new_results_.size() < kMostNewResults) new_results_.push_back(std::move(completed));
    }
    is_woken_ = true;
  }
  changed_.notify_one();
}

void EventHub::run(const std::stop_token& stop) {
  ThreadTicks ticks("fvd-events", kLongestLook);
  HostTime looked = HostClock::now();
  while (!stop.stop_requested()) {
    {
      MutexLock lock(mutex_);
      changed_.wait_until(lock, stop, looked + kLongestBetweenLooks, [this] {
        mutex_.assert_held();
        return is_woken_;
      });
      changed_.wait_until(lock, stop, looked + kBetweenLooks, [] { return false; });
      is_woken_ = false;
    }
    if (stop.stop_requested()) return;
    looked = HostClock::now();
    ticks.tick(looked);
    look();
    ticks.rest();
  }
}

void EventHub::look() {
  std::vector<std::string> results;
  {
    const MutexLock lock(mutex_);
    results = std::exchange(new_results_, {});
  }
  // After the results were taken: whoever is told of one was told that its job has ended.
  const auto machine = services_.machine.snapshot();
  const HostTime now = HostClock::now();
  std::array<std::optional<TopicDocument>, kTopics> found{};
  found[kState] = documents_.state(*machine);
  found[kJob] = documents_.job(*machine);
  found[kControl] = documents_.control();
  found[kHealth] = documents_.health();
  // Before the list: one that comes between the two is told by the next look.
  if (const std::uint64_t alarms = services_.alarms.revision(); seen_alarms_ != alarms || owes_alarms_) {
    seen_alarms_ = alarms;
    found[kAlarms] = documents_.alarms();
  }
  bool has_told = false;
  {
    const MutexLock lock(mutex_);
    const auto told_before = counts_.told;
    for (std::size_t i = 0; i < kTopics; ++i) {
      if (!found.at(i) || !topics_.at(i).take(*std::move(found.at(i)), now)) continue;
      ring_.add(kNames.at(i), topics_.at(i).text());
      ++counts_.told;
    }
    owes_alarms_ = topics_[kAlarms].owes();
    for (const std::string& job : results) {
      ring_.add("result", nlohmann::json{{"job_id", job}}.dump());
      ++counts_.told;
    }
    has_told = counts_.told > told_before;
  }
  if (!has_told) return;
  const MutexLock telling(telling_mutex_);
  for (const auto& [whose, listener] : listeners_) listener();
}

std::string EventHub::snapshot() {
  std::string text = "{";
  for (std::size_t i = 0; i < kTopics; ++i) {
    text.append(i == 0 ? "\"" : ",\"").append(kNames.at(i)).append("\":").append(topics_.at(i).show());
  }
  return event_text(ring_.id_of(ring_.newest()), "snapshot", text.append("}"));
}

EventHub::Told EventHub::everything_anew() {
  ++counts_.resyncs;
  return {event_text({}, "resync", "{}") + snapshot(), ring_.newest()};
}

EventHub::Told EventHub::begin(const std::optional<std::string>& last_event_id) {
  const MutexLock lock(mutex_);
  Told told;
  if (!last_event_id || last_event_id->empty()) {
    told = {snapshot(), ring_.newest()};
  } else if (const auto place = ring_.place_of(*last_event_id)) {
    told.place = *place;
  } else {
    told = everything_anew();
  }
  told.text.insert(0, kRetry);
  return told;
}

EventHub::Told EventHub::after(std::uint64_t place) {
  std::uint64_t missing = 0;
  Told told;
  {
    const MutexLock lock(mutex_);
    missing = ring_.missing_after(place);
    if (missing > 0) {
      counts_.dropped += missing;
      told = everything_anew();
    } else {
      auto texts = ring_.after(place, kMostAtOnce_bytes);
      told = {std::move(texts.text), texts.last};
    }
  }
  if (missing > 0) spdlog::info("events: a reader was too slow for {} events and is told everything anew", missing);
  return told;
}

void EventHub::on_events(std::function<void()> listener, const void* whose) {
  const MutexLock lock(telling_mutex_);
  if (listener) {
    listeners_[whose] = std::move(listener);
  } else {
    listeners_.erase(whose);
  }
}

EventCounts EventHub::counts() const {
  const MutexLock lock(mutex_);
  return counts_;
}

}  // namespace fvd
