#include "daemon/access/access_rules.hpp"

#include <algorithm>
#include <array>

#include <grp.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/access/access_error.hpp"
#include "daemon/access/token_file.hpp"

namespace fvd {

namespace {

constexpr std::size_t kGroupBuffer = 65536;  // a group may have thousands of members

std::optional<gid_t> group_id(const std::string& name) {
  std::vector<char> buffer(kGroupBuffer);
  group entry{};
  group* found = nullptr;
  const int error = ::getgrnam_r(name.c_str(), &entry, buffer.data(), buffer.size(), &found);
  if (error != 0 || found == nullptr) return std::nullopt;
  return entry.gr_gid;
}

}  // namespace

AccessRules::AccessRules(const AccessConfig& config)
    : loopback_role_(config.loopback_role), token_file_(config.token_file) {
  for (const AddressRule& rule : config.allow) {
    if (const auto range = AddressRange::parse(rule.address)) ranges_.push_back({*range, rule.role});
  }
  for (const GroupRule& rule : config.groups) {
    if (const auto id = group_id(rule.group)) {
      groups_.push_back({*id, rule.role});
    } else {
      spdlog::debug("there is no group {}: nobody has the role {} by it", rule.group, role_name(rule.role));
    }
  }
}

Identity AccessRules::of_address(const AddressBytes& address, const std::string& text) const {
  const Range* narrowest = nullptr;
  for (const Range& rule : ranges_) {
    if (!rule.range.contains(address)) continue;
    if (narrowest == nullptr || rule.range.prefix_bits() > narrowest->range.prefix_bits()) narrowest = &rule;
  }
  Identity identity{"address " + text, Role::kNone};
  if (narrowest != nullptr) {
    identity.role = narrowest->role;
  } else if (is_loopback(address)) {
    identity.role = loopback_role_;
  }
  return identity;
}

Identity AccessRules::of_local_peer(const LocalPeer& peer) const {
  Identity identity{"uid " + std::to_string(peer.uid), Role::kNone};
  if (peer.uid == 0 || peer.uid == ::geteuid()) {
    identity.role = Role::kAdminister;
    return identity;
  }
  for (const Group& group : groups_) {
    const bool member = std::find(peer.groups.begin(), peer.groups.end(), group.id) != peer.groups.end();
    if (member) identity.role = std::max(identity.role, group.role);
  }
  return identity;
}

std::optional<Identity> AccessRules::of_token(std::string_view token) const {
  if (token_file_.empty()) return std::nullopt;
  try {
    return holder_of(token, read_credentials(token_file_));
  } catch (const Error& error) {
    throw TokensUnreadable(error.what());
  }
}

}  // namespace fvd
