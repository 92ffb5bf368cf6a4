#pragma once

/// The daemon as a whole: owns everything; the order of the members is the order of start, its reverse that of stop.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/clock.hpp"
#include "daemon/config/config.hpp"
#include "daemon/events/event_hub.hpp"
#include "daemon/events/event_resource.hpp"
#include "daemon/jobs/engine.hpp"
#include "daemon/metrics/metrics_server.hpp"
#include "daemon/page/page_resource.hpp"
#include "daemon/resources/job_resource.hpp"
#include "daemon/resources/live_resource.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/transport/http_server.hpp"
#include "daemon/transport/rpc_server.hpp"

namespace fvd {

/// context: made and destroyed on the main thread, with the signals it waits for blocked.
class App {
 public:
  /// Opens the store, starts the engine and listens. start_anew: a database that is gone is not missed. alarms: that
  /// the log's lines come to, null = none do. Throws Error kDatabase, kStorageWrite, kStorageFull, kBadConfig.
  explicit App(const Config& config, bool start_anew = false, std::shared_ptr<AlarmLog> alarms = nullptr);
  /// Ordered stop: aborts the job, halts the stage, gives the devices up, sends the replies to open requests, closes
  /// the connections.
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  /// TCP port on which clients connect.
  [[nodiscard]] int rpc_port() const { return rpc_.port(); }
  /// That of the operator page and of POST /api/jsonrpc; nothing if there is none.
  [[nodiscard]] std::optional<int> http_port() const { return http_ ? std::optional(http_->port()) : std::nullopt; }
  /// That of /metrics and /healthz; nothing if there is none.
  [[nodiscard]] std::optional<int> metrics_port() const {
    return metrics_ ? std::optional(metrics_->port()) : std::nullopt;
  }
  [[nodiscard]] Engine& engine() { return engine_; }

 private:
  /// What can be fetched by HTTP; makes what it needs.
  [[nodiscard]] std::vector<MountedResource> resources();

  Config config_;
  SystemClock clock_;
  JobStore store_;
  Engine engine_;
  PageResource page_;
  std::optional<EventHub> events_;
  std::optional<EventResource> event_streams_;
  std::optional<JobResource> results_;
  std::optional<LiveResource> pictures_;
  RpcServer rpc_;
  std::optional<HttpServer> http_;
  std::optional<MetricsServer> metrics_;
};

}  // namespace fvd
