#pragma once

/// Tells lines of other protocols apart, so that a web page in a browser on this machine cannot speak to the daemon: a
/// browser sends a page's text to any port, as the body of an HTTP request or inside a TLS greeting.

#include <string_view>

namespace fvd {

/// True for a line that begins as an HTTP request or a TLS connection does. No JSON text begins so.
[[nodiscard]] bool begins_foreign_protocol(std::string_view line) noexcept;

}  // namespace fvd
