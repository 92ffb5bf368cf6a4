#include "drivers/common/network_address.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

namespace fvd {

namespace {

/// "stands for many machines" or "stands for no machine"; empty for an address of one.
std::string scope_problem(const in_addr& address) {
  const std::uint32_t host = ntohl(address.s_addr);
  if (host == INADDR_BROADCAST || IN_MULTICAST(host)) return "stands for many machines";
  if (host == INADDR_ANY) return "stands for no machine";
  return {};
}

bool has_the_form_of_ipv4(const std::string& text) {
  return text.find('.') != std::string::npos && text.find_first_not_of("0123456789.") == std::string::npos;
}

}  // namespace

std::string why_no_device(const std::string& address) {
  in_addr ipv4{};
  if (inet_pton(AF_INET, address.c_str(), &ipv4) == 1) {
    const std::string problem = scope_problem(ipv4);
    return problem.empty() ? problem : "'" + address + "' " + problem + "; expected the address of one device";
  }
  if (!has_the_form_of_ipv4(address)) return {};
  return "'" + address + "' is no IPv4 address; expected four numbers within 0..255 such as 192.168.10.20";
}

std::string why_no_listener(const std::string& address) {
  in_addr ipv4{};
  in6_addr ipv6{};
  if (inet_pton(AF_INET, address.c_str(), &ipv4) == 1) {
    if (ipv4.s_addr == htonl(INADDR_ANY) || scope_problem(ipv4).empty()) return {};
  } else if (inet_pton(AF_INET6, address.c_str(), &ipv6) == 1) {
    if (!IN6_IS_ADDR_MULTICAST(&ipv6)) return {};
  } else {
    return "'" + address +
           "' is no numeric address; expected e.g. 127.0.0.1 for this machine only or 0.0.0.0 for every interface";
  }
  return "'" + address + "' stands for many machines, and nobody can listen on it; expected an address of this one";
}

}  // namespace fvd
