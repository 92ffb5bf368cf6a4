#pragma once

/// JSON-RPC over TCP, one JSON text per line: for PLCs, fvdctl and any other client with a socket.

#include <filesystem>
#include <memory>

#include "daemon/config/config.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// Lines end with LF, CR, CRLF or NUL; replies end with LF. Requests of one connection are answered in their order.
/// A connection is closed after a line over 64 KiB, one that begins as HTTP or TLS does (nothing behind it is read), or
/// the third line in a row that is no JSON. So is a connection above max_connections, one that is silent for
/// idle_timeout_s, and one that does not read its replies. Owns a network thread, which answers requests for which the
/// machine's snapshot suffices, and threads for requests that may block: no client can delay another's ping, and no
/// list of jobs, values or heights another's start or result. A reply of more than 960 KiB becomes an error. A client
/// that has closed its sending side still gets the answers to its requests, unless its connection is needed for another
/// client.
class RpcServer {
 public:
  /// Listens, and writes <runtime_dir>/rpc.json {"address","port","pid"}. Becomes the machine's change listener.
  /// Throws Error kBadConfig (address), kStorageWrite (rpc.json).
  /// The objects in `services` outlive the server.
  RpcServer(const RpcConfig& config, const std::filesystem::path& runtime_dir, const Services& services);
  /// Closes all connections and removes rpc.json.
  ~RpcServer();

  [[nodiscard]] int port() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
