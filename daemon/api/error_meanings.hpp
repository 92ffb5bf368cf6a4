#pragma once

/// What error codes mean to those who read them, and what to do: for the table of daemon/README.md.

#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "daemon/access/access_error.hpp"

namespace fvd {

/// One sentence, and what to do.
[[nodiscard]] std::string_view error_meaning(ErrorCode code) noexcept;
[[nodiscard]] std::string_view error_meaning(AccessCode code) noexcept;

/// A table in Markdown of the codes that results give as reasons and no call fails with.
[[nodiscard]] std::string result_codes_markdown();

}  // namespace fvd
