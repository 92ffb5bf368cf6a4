#pragma once

/// Unpacks what gzip packed, for clients that cannot.

#include <string>
#include <string_view>

namespace fvd {

/// Throws Error kInternal for what is no gzip, and for an end in its middle.
[[nodiscard]] std::string unpacked(std::string_view gzip);

}  // namespace fvd
