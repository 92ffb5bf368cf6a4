#pragma once

/// Recognises callers: by their address, by the system's word for a local process, by a token.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "daemon/access/access_config.hpp"
#include "daemon/access/address_range.hpp"

namespace fvd {

/// A process at the other end of a unix socket, as the kernel tells it.
struct LocalPeer {
  pid_t pid = 0;
  uid_t uid = 0;
  std::vector<gid_t> groups;  ///< its own and the supplementary ones
};

/// context: thread-safe; never changes.
class AccessRules {
 public:
  /// Asks the system for the numbers of the groups, once; a group that does not exist lets nobody in.
  explicit AccessRules(const AccessConfig& config);

  /// Of several rules that fit the one with the longest prefix; without one loopback_role for 127.0.0.0/8 and ::1,
  /// else no role. Blocks for nothing, as the next.
  [[nodiscard]] Identity of_address(const AddressBytes& address, const std::string& text) const;
  /// root and the daemon's own user administer; of several groups the highest role.
  [[nodiscard]] Identity of_local_peer(const LocalPeer& peer) const;

  /// Nothing for a token that the file has not. Reads the file: what was taken out of it holds no longer. Throws
  /// TokensUnreadable.
  [[nodiscard]] std::optional<Identity> of_token(std::string_view token) const;
  [[nodiscard]] bool has_tokens() const noexcept { return !token_file_.empty(); }

 private:
  struct Range {
    AddressRange range;
    Role role = Role::kNone;
  };
  struct Group {
    gid_t id = 0;
    Role role = Role::kNone;
  };
  std::vector<Range> ranges_;
  Role loopback_role_;
  std::vector<Group> groups_;
  std::filesystem::path token_file_;
};

}  // namespace fvd
