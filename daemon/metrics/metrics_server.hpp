#pragma once

/// What watches a station reads here, by HTTP: nothing that anybody sends changes anything.

#include <memory>

#include "daemon/config/config.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// GET and HEAD of /metrics (Prometheus) and /healthz (200, or 503 with the reason); one request a connection, which
/// has 5 s. Connections above 8 are closed at once. Owns one thread, which asks the machine's snapshot and nothing
/// else.
class MetricsServer {
 public:
  /// Listens. Throws Error kBadConfig (address), kNotReady (port or address is not to be had). machine outlives it.
  MetricsServer(const std::string& address, int port, const MachineView& machine);
  /// Closes all connections.
  ~MetricsServer();

  [[nodiscard]] int port() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
