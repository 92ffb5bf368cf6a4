#pragma once

/// What can be fetched by GET and HEAD, apart from sockets and Beast: pages, maps, pictures, files.

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fvd {

/// A request whose header was let in.
struct ResourceRequest {
  std::string path;                          ///< decoded, begins with "/", without the query
  std::map<std::string, std::string> query;  ///< decoded; no key stands twice
  bool is_head = false;
  bool takes_gzip = false;
  std::optional<std::string> if_none_match;
  std::optional<std::string> range;
  std::optional<std::string> if_range;
  std::string address;                      ///< of the client
  std::chrono::milliseconds waited{0};      ///< since it was first asked; see ResourceAnswer::again_after
};

/// A body that is made while it is sent, so that one piece of it is in memory at a time. context: one thread at a time.
class BodySource {
 public:
  virtual ~BodySource() = default;
  /// The next bytes, 256 KiB at most; empty at the end. May read files. Throws Error: the connection is closed in the
  /// middle of the answer, which its Content-Length tells the client.
  virtual std::string next() = 0;
};

/// The transport adds Content-Length, Date, Connection and the fields that browsers' rules are made of.
struct ResourceAnswer {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> fields;  ///< "Content-Type", "ETag", "Cache-Control"
  std::string body;
  std::unique_ptr<BodySource> source;  ///< if there is one, it makes the body
  std::uint64_t source_bytes = 0;      ///< what it makes in all
  /// If there is one, nothing is sent yet: the same request comes again after this time, with `waited` grown.
  std::optional<std::chrono::milliseconds> again_after;
};

/// Everything below one path.
class HttpResource {
 public:
  virtual ~HttpResource() = default;
  /// False: everybody may have it whom the gate lets in; true: callers with the role `view` or more.
  [[nodiscard]] virtual bool needs_view() const { return true; }
  /// Throws Error: its message is the answer, with status 404 for kUnknownJob, 410 for kResultRemoved, 400 for
  /// kBadConfig and kRegionOutside, 503 for kShuttingDown and kNotReady, 500 else. context: the server's worker; may
  /// read files and the database.
  [[nodiscard]] virtual ResourceAnswer get(const ResourceRequest& request) = 0;
};

/// A resource and the path below which it is asked: "/api/v1/jobs/". "/" is what nothing else is found for. Of two
/// that fit the longer path wins.
struct MountedResource {
  std::string path;
  HttpResource* resource = nullptr;
};

}  // namespace fvd
