#include "daemon/access/token_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <glib.h>
#include <sys/random.h>
#include <sys/stat.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::size_t kTokenBytes = 32;
constexpr std::size_t kHashDigits = 64;
constexpr std::size_t kLongestName = 32;
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr std::string_view kNameCharacters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";

std::string sha256_digits(std::string_view text) {
  gchar* digits = g_compute_checksum_for_data(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(text.data()),
                                              static_cast<gsize>(text.size()));
  std::string result = digits;
  g_free(digits);
  return result;
}

/// Does not end early at the first difference.
bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept {
  if (a.size() != b.size()) return false;
  unsigned char differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differences |= static_cast<unsigned char>(a[i] ^ b[i]);
  return differences == 0;
}

bool is_name(std::string_view name) noexcept {
  return !name.empty() && name.size() <= kLongestName &&
         name.find_first_not_of(kNameCharacters) == std::string_view::npos;
}

Credential credential_from(const std::string& line, const std::string& place) {
  const auto refuse = [&place](const std::string& why) { throw Error(ErrorCode::kBadConfig, place + ": " + why); };
  std::istringstream words(line);
  Credential credential;
  std::string role;
  std::string more;
  words >> credential.name >> role >> credential.hash;
  if (credential.hash.empty() || words >> more) refuse("expected 'name role hash', as fvdctl token new prints it");
  if (!is_name(credential.name)) refuse("the name must be 1 to 32 letters, digits, '.', '_' and '-'");
  const auto known = role_from_name(role);
  // The word itself may be a token that stands in the wrong place.
  if (!known) refuse("the second word is no role; expected view, operate, set_up or administer");
  credential.role = known.value_or(Role::kNone);
  if (credential.hash.size() != kHashDigits || credential.hash.find_first_not_of(kHexDigits) != std::string::npos) {
    refuse("the hash must be 64 digits 0..9, a..f; a token itself does not belong here");
  }
  return credential;
}

void require_safe(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    throw Error(ErrorCode::kBadConfig, "cannot read " + file.string() + ": " + std::strerror(errno));
  }
  if ((status.st_mode & S_IWOTH) == 0) return;
  throw Error(ErrorCode::kBadConfig, file.string() + " can be written by everybody: chmod o-w it");
}

}  // namespace

std::string Credential::line() const { return name + " " + std::string(role_name(role)) + " " + hash; }

std::string new_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw Error(ErrorCode::kInternal, std::string("the system gives no random numbers: ") + std::strerror(errno));
  }
  std::string token = "fvd-";
  for (const unsigned char byte : bytes) {
    token += kHexDigits[byte >> 4U];
    token += kHexDigits[byte & 0xFU];
  }
  return token;
}

Credential credential_of(const std::string& name, Role role, std::string_view token) {
  if (!is_name(name)) {
    throw Error(ErrorCode::kBadInput, "'" + name + "' is no name: 1 to 32 letters, digits, '.', '_' and '-'");
  }
  return {name, role, sha256_digits(token)};
}

std::vector<Credential> read_credentials(const std::filesystem::path& file) {
  require_safe(file);
  std::ifstream in(file);
  if (!in) throw Error(ErrorCode::kBadConfig, "cannot read " + file.string() + ": " + std::strerror(errno));
  std::vector<Credential> credentials;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#') continue;
    const std::string place = file.string() + ", line " + std::to_string(number);
    Credential credential = credential_from(line, place);
    const bool known = std::any_of(credentials.begin(), credentials.end(),
                                   [&](const Credential& other) { return other.name == credential.name; });
    if (known) throw Error(ErrorCode::kBadConfig, place + ": '" + credential.name + "' stands there already");
    credentials.push_back(std::move(credential));
  }
  return credentials;
}

std::optional<Identity> holder_of(std::string_view token, const std::vector<Credential>& credentials) {
  const std::string hash = sha256_digits(token);
  std::optional<Identity> found;
  for (const Credential& credential : credentials) {
    if (equal_in_constant_time(credential.hash, hash)) found = Identity{"token " + credential.name, credential.role};
  }
  return found;
}

}  // namespace fvd
