#pragma once

/// What can be fetched by GET and HEAD, apart from sockets and Beast: pages, maps, pictures, files.

#include <chrono>
#include <cstdint>
#include <functional>
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
  std::string address;                  ///< of the client
  std::chrono::milliseconds waited{0};  ///< since it was first asked; see ResourceAnswer::again_after
  std::optional<std::string> last_event_id{};
  bool has_token = false;  ///< that somebody has
};

/// A body that is made while it is sent, so that one piece of it is in memory at a time. context: one thread at a time.
class BodySource {
 public:
  virtual ~BodySource() = default;
  /// The next bytes, 256 KiB at most; empty at the end. May read files. Throws Error: the connection is closed in the
  /// middle of the answer, which its Content-Length tells the client.
  virtual std::string next() = 0;
};

/// A body that grows while it is sent and does not end by itself: events. The client's end, or the daemon's, ends it,
/// and destroys this. context: one thread at a time, but for `ready`.
class StreamSource {
 public:
  virtual ~StreamSource() = default;
  /// What there is to send now, 64 KiB or one event that is longer; empty: nothing. Blocks for nothing. It is not
  /// called before what it gave last was sent: a client that does not read holds one piece in memory, and loses what
  /// this has dropped by the next call. One that reads nothing of a piece for 15 s is closed.
  virtual std::string next() = 0;
  /// Sent every ping_period() whatever else is sent, so that both ends notice when the other is gone.
  [[nodiscard]] virtual std::string ping() const = 0;
  [[nodiscard]] virtual std::chrono::milliseconds ping_period() const = 0;
  /// ready: called, from any thread, when next() may have something; it returns at once. An empty one ends it: after
  /// the return the one before is not called again.
  virtual void on_ready(std::function<void()> ready) = 0;
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
  std::unique_ptr<StreamSource> stream{};  ///< if there is one, it makes a body without length, to the connection's end
  bool is_endless = false;                 ///< the answer to HEAD, where a GET would have such a stream
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
