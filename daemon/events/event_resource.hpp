#pragma once

/// GET /api/v1/events: the events as a stream (text/event-stream).

#include <cstddef>
#include <memory>
#include <string>

#include "daemon/events/event_hub.hpp"
#include "daemon/transport/http_resource.hpp"

namespace fvd {

/// A stream begins with a snapshot, or goes on behind Last-Event-ID; event ping every 15 s.
class EventResource final : public HttpResource {
 public:
  static constexpr const char* kPath = "/api/v1/events";
  static constexpr std::size_t kMostOfAddress = 8;
  /// Of all addresses. Fewer than the server has places for callers without a token: the others are for what is
  /// fetched.
  static constexpr std::size_t kMost = 24;
  /// Of these: strangers leave places to those whom a token vouches for.
  static constexpr std::size_t kMostWithoutToken = 16;

  /// hub: outlives this and every stream.
  explicit EventResource(EventHub& hub);
  ~EventResource() override;

  /// 503 too_many_streams; 404 below the path.
  [[nodiscard]] ResourceAnswer get(const ResourceRequest& request) override;

 private:
  class Places;
  class Stream;

  EventHub& hub_;
  const std::shared_ptr<Places> places_;
};

}  // namespace fvd
