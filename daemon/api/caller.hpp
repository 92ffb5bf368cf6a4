#pragma once

/// Who calls a method.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "core/base/clock.hpp"
#include "daemon/access/role.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

struct Caller {
  std::uint64_t connection = 0;       ///< counts the connections since the daemon's start, from 1
  std::string peer{};                 ///< address and port of the other end, for the log
  std::string name = kDefaultClient;  ///< the client's, as its request gives it
  Identity who{};                     ///< as the transport recognised him
  HostTime received{};                ///< when the request came
  /// That its connection takes; a longer one becomes an error.
  std::size_t longest_reply_bytes = std::numeric_limits<std::size_t>::max();
};

/// "plc (connection 3, 192.168.0.7:40312, address 192.168.0.7, operate)", for the log.
[[nodiscard]] std::string text_of(const Caller& caller);

inline constexpr std::size_t kLongestClientName_bytes = 32;
/// True for 1 to 32 letters, digits, '.', '_' and '-'.
[[nodiscard]] bool is_client_name(std::string_view name) noexcept;

}  // namespace fvd
