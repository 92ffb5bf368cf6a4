#include "daemon/access/role.hpp"

#include <algorithm>

namespace fvd {

std::string_view role_name(Role role) noexcept {
  switch (role) {
    case Role::kNone:
      return "none";
    case Role::kView:
      return "view";
    case Role::kOperate:
      return "operate";
    case Role::kSetUp:
      return "set_up";
    case Role::kAdminister:
      return "administer";
  }
  return "none";
}

std::optional<Role> role_from_name(std::string_view name) noexcept {
  const auto found =
      std::find_if(kGivenRoles.begin(), kGivenRoles.end(), [name](Role role) { return role_name(role) == name; });
  return found == kGivenRoles.end() ? std::nullopt : std::optional(*found);
}

}  // namespace fvd
