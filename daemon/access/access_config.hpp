#pragma once

/// Who may what, as the configuration says it.

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/access/role.hpp"

namespace fvd {

struct AddressRule {
  std::string address;  ///< one address, or a range as "192.168.1.0/24"
  Role role = Role::kView;
};

struct GroupRule {
  std::string group;  ///< of the system
  Role role = Role::kView;
};

struct AccessConfig {
  std::vector<AddressRule> allow;  ///< of the TCP port; of several that fit the narrowest holds
  Role loopback_role = Role::kOperate;
  std::vector<GroupRule> groups{{"fvd", Role::kOperate}, {"fvd-view", Role::kView}};  ///< of the unix socket
  std::filesystem::path token_file;                                                   ///< empty = none
};

}  // namespace fvd
