#pragma once

/// JSON-RPC over HTTP: POST /api/jsonrpc, with the same methods, roles and notes as the line protocol.

#include <memory>

#include "daemon/config/config.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// A caller is who his token says (Authorization: Bearer), or somebody of his address who may look at most. Every
/// answer of JSON-RPC comes with status 200, 204 where there is nothing to say; what is no request of it is refused
/// with a status and a line of JSON. Limits: header 16 KiB, body 64 KiB, 10 s for each of them, 60 s between two
/// requests, 64 connections, of which one that has no request at work gives way to a new one. Owns a network thread and
/// two that may block, so that nobody here delays a client of the line protocol.
class HttpServer {
 public:
  /// Listens. Becomes one of the machine's change listeners. Throws Error kBadConfig (address), kNotReady (port or
  /// address is not to be had). The objects in `services` outlive the server.
  HttpServer(const HttpConfig& config, const Services& services);
  /// Sends the answers that are owed within 0.5 s, then closes all connections.
  ~HttpServer();

  [[nodiscard]] int port() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
