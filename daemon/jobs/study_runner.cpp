#include "daemon/jobs/study_runner.hpp"

#include <exception>
#include <utility>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "config/field_writer.hpp"
#include "core/runtime/guarded_thread.hpp"

namespace fvd {

namespace {

constexpr const char* kThreadName = "fvd-study";
/// One map of five million points is read and evaluated in much less, and the figures of twenty are found.
constexpr std::chrono::minutes kLongestPiece{10};
constexpr int kNiceness = 10;

}  // namespace

std::string study_reply_text(const Study& study, const std::filesystem::path& folder) {
  Study shown = study;
  return nlohmann::ordered_json{{"study", fields_to_json([&shown](Fields& fields) { describe(shown, fields); })},
                                {"directory", folder.string()},
                                {"report", (folder / "report.pdf").string()}}
      .dump();
}

StudyRunner::StudyRunner(StudyDesk& desk, std::function<void()> ended)
    : desk_(desk),
      ended_(std::move(ended)),
      ticks_(kThreadName, kLongestPiece),
      thread_(start_thread(kThreadName, [this](std::stop_token stop) { run(stop); })) {}

StudyRunner::~StudyRunner() { finish(); }

std::shared_ptr<DeviceTask> StudyRunner::begin(StudyRequest request) {
  auto task = std::make_shared<DeviceTask>(DeviceTask::Work{});
  {
    const MutexLock lock(mutex_);
    if (stopping_) throw Error(ErrorCode::kShuttingDown, "the daemon is shutting down");
    if (busy_) throw Error(ErrorCode::kBusy, "another study is being made; try again when it is done");
    busy_ = true;
    next_ = Order{std::move(request), task};
  }
  changed_.notify_one();
  return task;
}

void StudyRunner::request_stop() noexcept {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  thread_.request_stop();
}

void StudyRunner::finish() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

DeviceTask::Outcome StudyRunner::outcome_of(const StudyRequest& request, const std::stop_token& stop) noexcept {
  try {
    const Study study = desk_.make(request, stop, [this] { ticks_.tick(HostClock::now()); });
    return {study_reply_text(study, desk_.studies().folder_of(study.id)), std::nullopt, {}};
  } catch (const Error& error) {
    return {{}, error.code(), error.what()};
  } catch (const std::exception& error) {
    return {{}, ErrorCode::kInternal, error.what()};
  }
}

void StudyRunner::run(const std::stop_token& stop) {
  (void)::setpriority(PRIO_PROCESS, 0, kNiceness);  // of this thread alone; without it a study is only less polite
  for (;;) {
    std::optional<Order> order;
    {
      MutexLock lock(mutex_);
      (void)changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return next_.has_value();
      });
      if (!next_) return;
      order = std::exchange(next_, std::nullopt);
    }
    ticks_.tick(HostClock::now());
    DeviceTask::Outcome outcome = outcome_of(order->request, stop);
    ticks_.rest();
    {
      const MutexLock lock(mutex_);
      busy_ = false;
    }
    order->task->end(std::move(outcome));
    if (ended_) ended_();
  }
}

}  // namespace fvd
