#include "daemon/app.hpp"

#include <chrono>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/jobs/reconcile_results.hpp"

namespace fvd {

namespace {

std::filesystem::path prepared_state_dir(const PathsConfig& paths) {
  try {
    (void)make_directories(paths.state_dir / "results");
  } catch (const Error& failure) {
    throw Error(failure.code(), std::string(failure.what()) + "; see /paths/state_dir");
  }
  return paths.state_dir;
}

/// Clears what a killed process left, once the open store says that no other process has the folder.
JobStore& with_cleared_results(JobStore& store, const PathsConfig& paths) {
  restore_refused_evaluations(store, paths.state_dir / "results");
  remove_abandoned_directories(paths.state_dir / "results");
  (void)reconcile_results(store, paths.state_dir / "results");
  return store;
}

}  // namespace

App::App(const Config& config, bool start_anew, std::shared_ptr<AlarmLog> alarms)
    : config_(config),
      store_(prepared_state_dir(config_.paths) / "fvd.sqlite",
             {std::chrono::seconds(config_.rpc.repeat_window_s), start_anew}),
      engine_(config_, {.store = with_cleared_results(store_, config_.paths),
                        .clock = clock_,
                        .openers = openers_of(config_),
                        .alarms = std::move(alarms)}),
      rpc_(config_.rpc, config_.paths.runtime_dir, engine_.services()) {
  if (config_.http.port) http_.emplace(config_.http, engine_.services(), resources());
  const MetricsConfig& metrics = config_.metrics;
  if (metrics.port) metrics_.emplace(metrics.address, *metrics.port, engine_.services().machine);
  // No device is touched by a program that cannot have its ports: another fvd may be measuring with them.
  engine_.start();
}

std::vector<MountedResource> App::resources() {
  events_.emplace(engine_.services());
  event_streams_.emplace(*events_);
  results_.emplace(engine_.services().results);
  pictures_.emplace(engine_.pictures());
  return {{"/", &page_}, {EventResource::kPath, &*event_streams_}, {kJobsPath, &*results_}, {kLivePath, &*pictures_}};
}

// The connections live until all that was accepted has ended.
App::~App() { engine_.finish(); }

}  // namespace fvd
