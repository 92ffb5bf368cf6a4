/// What readers are told, with the hub's thread.

#include "daemon/events/event_hub.hpp"

#include <atomic>
#include <chrono>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/daemon/events/changing_machine.hpp"
#include "tests/support/captured_log.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct SentEvent {
  std::string id;
  std::string name;
  json data;
};

std::vector<SentEvent> events_in(const std::string& text) {
  std::vector<SentEvent> events;
  std::istringstream lines(text);
  SentEvent event;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("id: ")) event.id = line.substr(4);
    if (line.starts_with("event: ")) event.name = line.substr(7);
    if (line.starts_with("data: ")) event.data = json::parse(line.substr(6));
    if (line.empty() && !event.name.empty()) events.push_back(std::exchange(event, {}));
  }
  return events;
}

class AnEventHub : public ::testing::Test {
 protected:
  /// A reader's next events, waited for; none: they did not come.
  std::vector<SentEvent> next(EventHub& hub, std::uint64_t& place) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
    while (std::chrono::steady_clock::now() < deadline) {
      const auto told = hub.after(place);
      place = told.place;
      if (!told.text.empty()) return events_in(told.text);
      std::this_thread::yield();
    }
    return {};
  }
  /// Events up to one of this name.
  std::vector<SentEvent> until(EventHub& hub, std::uint64_t& place, const std::string& name) {
    std::vector<SentEvent> all;
    for (;;) {
      const auto more = next(hub, place);
      all.insert(all.end(), more.begin(), more.end());
      for (const SentEvent& event : more) {
        if (event.name == name) return all;
      }
      if (more.empty()) {
        ADD_FAILURE() << "no event " << name;
        return all;
      }
    }
  }
  test::ChangingMachine machine_;
  FakeJobService service_;
  const Services services_ = machine_.in(service_.services());
};

TEST_F(AnEventHub, BeginsWithASnapshot) {
  EventHub hub(services_);
  const auto told = hub.begin({});
  EXPECT_THAT(told.text, StartsWith("retry: 2000\n\n"));
  const auto events = events_in(told.text);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].name, "snapshot");
  EXPECT_EQ(events[0].id, "17-0");
  const json& all = events[0].data;
  EXPECT_EQ(all["state"]["state"], "ready");
  EXPECT_EQ(all["job"], nullptr);
  EXPECT_EQ(all["control"]["owner"], "");
  EXPECT_TRUE(all["health"]["ok"].get<bool>());
  EXPECT_EQ(all["alarms"][0]["text"], "the disk is nearly full");
  EXPECT_EQ(all.size(), 5U);
}

TEST_F(AnEventHub, TellsWhatChangedAndNothingElse) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  machine_.change([](MachineStatus& status) { status.state = ScanState::kExecuting; });
  auto events = next(hub, place);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].name, "state");
  EXPECT_EQ(events[0].id, "17-1");
  EXPECT_EQ(events[0].data["state"], "executing");
  machine_.change([](MachineStatus&) {});
  machine_.change([](MachineStatus& status) { status.recipe = "groove"; });
  events = next(hub, place);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].id, "17-2");
  EXPECT_EQ(events[0].data["recipe"], "groove");
}

TEST_F(AnEventHub, TellsOfJobsAndTheirResults) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  machine_.start_job("job-1");
  EXPECT_EQ(until(hub, place, "job").back().data["state"], "processing");
  machine_.end_job(JobState::kCompleted);
  const auto events = until(hub, place, "result");
  EXPECT_EQ(events.back().name, "result");
  EXPECT_EQ(events.back().data, (json{{"job_id", "job-1"}}));
  ASSERT_GE(events.size(), 2U);
  EXPECT_EQ(events[events.size() - 2].data["state"], "completed") << "the job's end comes before";
}

TEST_F(AnEventHub, TellsTheResultsOfAllThatCompleted) {
  machine_.start_job("job-0");
  machine_.end_job(JobState::kCompleted);
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  for (int i = 1; i <= 5; ++i) {
    machine_.start_job("job-" + std::to_string(i));
    machine_.end_job(i == 3 ? JobState::kFailed : JobState::kCompleted);
  }
  std::vector<std::string> completed;
  while (completed.size() < 4) {
    for (const SentEvent& event : until(hub, place, "result")) {
      if (event.name == "result") completed.push_back(event.data["job_id"]);
    }
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_THAT(completed, ElementsAre("job-1", "job-2", "job-4", "job-5")) << "what ended before it is no news";
}

TEST_F(AnEventHub, LosesNoResultToTheNextJob) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  machine_.start_job("job-1");
  // What a listener sees that is called after the next job was accepted.
  machine_.change([](MachineStatus& status) {
    status.completed_job = "job-1";
    status.job->job_id = "job-2";
  });
  EXPECT_EQ(until(hub, place, "result").back().data, (json{{"job_id", "job-1"}}));
}

TEST_F(AnEventHub, TellsWhoHasControl) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  const Identity kiosk{"token kiosk", Role::kOperate};
  (void)services_.control.acquire({kiosk, "anna", std::chrono::seconds(60)});
  auto events = until(hub, place, "control");
  EXPECT_EQ(events.back().data["owner"], "anna");
  EXPECT_EQ(events.back().data["yours"], false);
  services_.control.release(kiosk.name);
  EXPECT_EQ(until(hub, place, "control").back().data["owner"], "");
}

TEST_F(AnEventHub, TellsOfControlThatIsOver) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  (void)services_.control.acquire({{"token kiosk", Role::kOperate}, "anna", std::chrono::seconds(1)});
  EXPECT_EQ(until(hub, place, "control").back().data["owner"], "anna");
  EXPECT_EQ(until(hub, place, "control").back().data["owner"], "") << "nobody told it";
}

TEST_F(AnEventHub, TellsOfAlarms) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  service_.alarms.note(AlarmLevel::kError, "it is warm", {});
  const json two = until(hub, place, "alarms").back().data;
  ASSERT_EQ(two.size(), 2U) << "nobody woke the hub";
  EXPECT_EQ(two[0]["text"], "it is warm");
  service_.alarms.acknowledge(2, "");
  EXPECT_EQ(until(hub, place, "alarms").back().data[0]["acknowledged"], true);
}

TEST_F(AnEventHub, ForgetsNoAlarmThatWaits) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  for (int i = 0; i < 20; ++i) service_.alarms.note(AlarmLevel::kError, "alarm " + std::to_string(i), {});
  std::size_t told = 1;
  while (told < 21 && !HasFailure()) told = until(hub, place, "alarms").back().data.size();
  EXPECT_EQ(told, 21U);
}

TEST_F(AnEventHub, GoesOnWhereAReaderWas) {
  EventHub hub(services_);
  std::uint64_t place = hub.begin({}).place;
  machine_.change([](MachineStatus& status) { status.recipe = "a"; });
  const std::string seen = until(hub, place, "state").back().id;
  machine_.change([](MachineStatus& status) { status.recipe = "b"; });
  (void)until(hub, place, "state");
  auto again = hub.begin(seen);
  EXPECT_EQ(again.text, "retry: 2000\n\n") << "no snapshot";
  const auto missed = next(hub, again.place);
  ASSERT_EQ(missed.size(), 1U);
  EXPECT_EQ(missed[0].data["recipe"], "b");
  EXPECT_EQ(hub.begin(missed[0].id).place, place);
}

TEST_F(AnEventHub, TellsEverythingAnewWhereAPlaceIsUnknown) {
  EventHub hub(services_);
  for (const char* unknown : {"16-0", "17-1", "17-99", "x", "17-0\nevent: y", "-1"}) {
    const auto told = hub.begin(unknown);
    EXPECT_EQ(told.place, 0U);
    const auto events = events_in(told.text);
    ASSERT_EQ(events.size(), 2U) << unknown;
    EXPECT_EQ(events[0].name, "resync");
    EXPECT_EQ(events[0].id, "");
    EXPECT_EQ(events[1].name, "snapshot");
    EXPECT_EQ(events[1].id, "17-0");
  }
  EXPECT_EQ(events_in(hub.begin("").text).size(), 1U) << "no id is no place";
  EXPECT_EQ(hub.counts().resyncs, 6U);
  EXPECT_EQ(hub.counts().dropped, 0U);
}

TEST_F(AnEventHub, TellsASlowReaderEverythingAnew) {
  const test::CapturedLog log;
  EventHub hub(services_);
  const std::uint64_t slow = hub.begin({}).place;
  std::uint64_t place = slow;
  // Long documents fill the ring sooner than many.
  for (int i = 0; hub.counts().told < 20 && !HasFailure(); ++i) {
    machine_.change(
        [i](MachineStatus& status) { status.recipe = std::string(2'000'000, static_cast<char>('a' + i % 26)); });
    (void)until(hub, place, "state");
  }
  const auto events = events_in(hub.after(slow).text);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].name, "resync");
  EXPECT_EQ(events[1].name, "snapshot");
  EXPECT_EQ(events[1].data["state"]["state"], "ready");
  EXPECT_GT(hub.counts().dropped, 10U);
  EXPECT_EQ(hub.counts().resyncs, 1U);
  EXPECT_THAT(log.text(), HasSubstr("too slow for"));
}

TEST_F(AnEventHub, WakesItsReaders) {
  EventHub hub(services_);
  std::atomic<int> woken{0};
  hub.on_events([&woken] { ++woken; }, this);
  machine_.change([](MachineStatus& status) { status.recipe = "a"; });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
  while (woken == 0 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  EXPECT_GE(woken, 1);
  hub.on_events({}, this);
  const int before = woken;
  std::uint64_t place = hub.begin({}).place;
  machine_.change([](MachineStatus& status) { status.recipe = "b"; });
  (void)until(hub, place, "state");
  EXPECT_EQ(woken, before);
}

TEST_F(AnEventHub, HearsNothingAfterItsEnd) {
  {
    const EventHub hub(services_);
    EXPECT_EQ(machine_.listeners(), 1U);
  }
  EXPECT_EQ(machine_.listeners(), 0U);
  (void)services_.control.acquire({{"token kiosk", Role::kOperate}, "anna", std::chrono::seconds(1)});
}

}  // namespace
}  // namespace fvd
