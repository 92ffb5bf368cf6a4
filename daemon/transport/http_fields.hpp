#pragma once

/// Fields of a header as rules: which ones every answer has, and what those of a request mean. Plain texts, no sockets.

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

namespace fvd {

/// Every answer has them. A browser runs scripts of this address alone, shows its pages in no frame, sends no forms,
/// guesses no types, tells nobody where it was, gives pages no devices, and no answer to pages of others.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kSecurityFields{{
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Permissions-Policy",
     "camera=(), display-capture=(), geolocation=(), hid=(), microphone=(), midi=(), payment=(), serial=(), usb=()"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
}};

/// True where Accept-Encoding names gzip, or anything, and not with q=0.
[[nodiscard]] bool takes_gzip(std::string_view accept_encoding);

/// True where If-None-Match has this ETag, or "*": the client has what it asks for. Weak and strong ones are compared
/// as if they were weak. etag: with its quotes; an empty one matches nothing.
[[nodiscard]] bool names_etag(std::string_view if_none_match, std::string_view etag);

/// True for what a field's value may hold: printable ASCII and blanks, so that nothing in it can begin another field.
[[nodiscard]] bool is_field_value(std::string_view text);
/// True for what a field may be called.
[[nodiscard]] bool is_field_name(std::string_view text);

/// "Mon, 30 Nov 2026 10:00:00 GMT"
[[nodiscard]] std::string http_date(std::chrono::system_clock::time_point time);

}  // namespace fvd
