#pragma once

/// JSON-RPC over HTTP: POST /api/jsonrpc, with the same methods, roles and notes as the line protocol; and what can be
/// fetched by GET.

#include <memory>
#include <vector>

#include "daemon/config/config.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/transport/http_resource.hpp"

namespace fvd {

/// A caller is who his token says (Authorization: Bearer), or somebody of his address who may look at most. Every
/// answer of JSON-RPC comes with status 200, 204 where there is nothing to say; what is no request of it is refused
/// with a status and a line of JSON. What is fetched comes with the status that its resource gives it. Limits: header
/// 16 KiB, target 2 KiB, body 1 MiB, 10 s for header and body and for each 256 KiB of an answer, 60 s between two
/// requests, 64 connections, of which one that has no request at work gives way to a new one, and 32 requests at a time
/// of callers without a token. Owns a network thread and three that may block: nobody here delays a client of the line
/// protocol, and nobody who fetches delays a call.
class HttpServer {
 public:
  /// Listens. Becomes one of the machine's change listeners. Throws Error kBadConfig (address), kNotReady (port or
  /// address is not to be had). The objects in `services` outlive the server, and so do the resources, which are asked
  /// on one thread.
  HttpServer(const HttpConfig& config, const Services& services, std::vector<MountedResource> resources = {});
  /// Sends the answers that are owed within 0.5 s, to what still waits kShuttingDown, then closes all connections.
  ~HttpServer();

  [[nodiscard]] int port() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
