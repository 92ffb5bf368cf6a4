#pragma once

/// The live picture: GET /api/v1/preview.jpg?after=N, which waits for a picture that is not number N.

#include "daemon/transport/http_resource.hpp"
#include "daemon/views/live_picture.hpp"

namespace fvd {

/// The path at which it is mounted.
inline constexpr const char* kLivePath = "/api/v1/preview.jpg";

/// 200 with a JPEG and its facts in fields X-Fvd-..., or 204 where 5 s brought nothing new. context: thread-safe.
class LiveResource final : public HttpResource {
 public:
  /// pictures outlives it.
  explicit LiveResource(PictureSource& pictures) : live_(pictures) {}

  [[nodiscard]] ResourceAnswer get(const ResourceRequest& request) override;

 private:
  LivePicture live_;
};

}  // namespace fvd
