#pragma once

/// What a caller may do to the instrument, and who he was recognised as.

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace fvd {

/// Each may all that the ones before it may.
enum class Role {
  kNone,       ///< nothing but to say who he is
  kView,       ///< look
  kOperate,    ///< start, stop, acknowledge
  kSetUp,      ///< recipes, moves, exposure, studies
  kAdminister  ///< constants of the instrument; take control from another
};
/// Those that a configuration may give.
inline constexpr std::array kGivenRoles{Role::kView, Role::kOperate, Role::kSetUp, Role::kAdminister};

/// "none", "view", "operate", "set_up", "administer".
[[nodiscard]] std::string_view role_name(Role role) noexcept;
/// Nothing for a text that names none of kGivenRoles.
[[nodiscard]] std::optional<Role> role_from_name(std::string_view name) noexcept;

/// By what somebody was recognised: a statement of the system or a secret, never what he says of himself.
struct Identity {
  std::string name;  ///< "address 192.168.1.10", "uid 1000", "token kiosk"; empty = nobody
  Role role = Role::kNone;

  bool operator==(const Identity&) const = default;
};

}  // namespace fvd
