#include "daemon/api/caller.hpp"

namespace fvd {

std::string text_of(const Caller& caller) {
  std::string text = caller.name + " (connection " + std::to_string(caller.connection);
  if (!caller.peer.empty()) text += ", " + caller.peer;
  if (!caller.who.name.empty()) text += ", " + caller.who.name;
  return text + ", " + std::string(role_name(caller.who.role)) + ")";
}

bool is_client_name(std::string_view name) noexcept {
  constexpr std::string_view kAccepted = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  return !name.empty() && name.size() <= kLongestClientName_bytes &&
         name.find_first_not_of(kAccepted) == std::string_view::npos;
}

}  // namespace fvd
