#pragma once

/// The operator page's files, as they are in this program.

#include <span>
#include <string_view>

namespace fvd {

/// All of it lives as long as the program.
struct PageFile {
  std::string_view path;    ///< "/index.html", "/assets/main-1a2b3c.js"
  std::string_view type;    ///< "text/html; charset=utf-8"
  std::string_view tag;     ///< differs for every other content; letters and digits
  std::string_view packed;  ///< the content, by gzip
};

/// Empty where the program was built without the page.
[[nodiscard]] std::span<const PageFile> page_files() noexcept;

}  // namespace fvd
