#pragma once

/// A large view of a map as the body of an answer, made while it is sent.

#include <string>
#include <utility>

#include "daemon/transport/http_resource.hpp"
#include "daemon/views/height_view.hpp"

namespace fvd {

/// The bytes of HeightView::whole(), some rows at a time; reads the map once for each plane.
class ViewStream final : public BodySource {
 public:
  explicit ViewStream(HeightView view) : view_(std::move(view)) {}
  /// Throws Error kSurfaceFile.
  std::string next() override;

 private:
  HeightView view_;
  bool begun_ = false;
  int plane_ = 0;
  int row_ = 0;  // the next one
};

}  // namespace fvd
