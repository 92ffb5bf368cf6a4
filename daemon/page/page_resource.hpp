#pragma once

/// The operator page, from the program itself: no file of the disk is read.

#include <span>

#include "daemon/page/page_files.hpp"
#include "daemon/transport/http_resource.hpp"

namespace fvd {

/// index.html for every path that the page has a view for (/, /jobs, /jobs/ID, /recipes, /recipes/ID, /setup), its
/// assets and its icon; 404 for all else. Compressed as they are for clients that take gzip. A program that was built
/// without the page has a plain one in its place that says so.
/// context: thread-safe; never changes.
class PageResource final : public HttpResource {
 public:
  explicit PageResource(std::span<const PageFile> files = page_files()) : files_(files) {}

  /// Whoever has no role yet gives his token in the page.
  [[nodiscard]] bool needs_view() const override { return false; }
  [[nodiscard]] ResourceAnswer get(const ResourceRequest& request) override;

 private:
  std::span<const PageFile> files_;
};

}  // namespace fvd
