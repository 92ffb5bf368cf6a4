#pragma once

/// Who calls a method.

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/store/job_status.hpp"

namespace fvd {

/// What a caller is to the machine.
enum class Role { kOperator };
[[nodiscard]] std::string_view role_name(Role role) noexcept;

struct Caller {
  std::uint64_t connection = 0;       ///< counts the connections since the daemon's start, from 1
  std::string peer;                   ///< address and port of the other end, for the log
  std::string name = kDefaultClient;  ///< the client's, as its request gives it
  Role role = Role::kOperator;
};

/// "plc (connection 3, 192.168.0.7:40312)", for the log.
[[nodiscard]] std::string text_of(const Caller& caller);

inline constexpr std::size_t kLongestClientName_bytes = 32;
/// True for 1 to 32 letters, digits, '.', '_' and '-'.
[[nodiscard]] bool is_client_name(std::string_view name) noexcept;

}  // namespace fvd
