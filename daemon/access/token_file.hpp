#pragma once

/// The credential file: who has which secret, without the secrets.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/access/role.hpp"

namespace fvd {

/// One line "name role hash". hash: SHA-256 of the token, 64 hexadecimal digits. A token has 256 random bits: there is
/// nothing to guess that a slow hash would protect.
struct Credential {
  std::string name;  ///< 1 to 32 letters, digits, '.', '_' and '-'
  Role role = Role::kView;
  std::string hash;

  [[nodiscard]] std::string line() const;
};

/// A new token, "fvd-" and 64 hexadecimal digits, from the system's random numbers. Throws Error kInternal.
[[nodiscard]] std::string new_token();
/// The credential of a token. Throws Error kBadInput for a name that is none.
[[nodiscard]] Credential credential_of(const std::string& name, Role role, std::string_view token);

/// Empty lines and those that begin with # say nothing. Throws Error kBadConfig that names file and line: it cannot be
/// read, others may write it, a line is no credential, a name stands twice.
[[nodiscard]] std::vector<Credential> read_credentials(const std::filesystem::path& file);

/// Who has the token; nothing for one that is unknown. Takes as long whichever is the right one.
[[nodiscard]] std::optional<Identity> holder_of(std::string_view token, const std::vector<Credential>& credentials);

}  // namespace fvd
