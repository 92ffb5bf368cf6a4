#include "daemon/ctl/connection.hpp"

#include <exception>

#include "daemon/access/role.hpp"
#include "daemon/ctl/access_commands.hpp"

namespace fvd::ctl {

namespace {

Role role_by(const RpcEndpoint& way) {
  const auto role = RpcClient(way).call("session.info").at("role").get<std::string>();
  return role_from_name(role).value_or(Role::kNone);
}

}  // namespace

RpcClient connect(const ConnectionArguments& arguments) {
  RpcClient client(arguments.address.empty() ? read_endpoint(arguments.runtime_dir)
                                             : parse_endpoint(arguments.address));
  if (!arguments.token_file.empty()) log_in(client, arguments.token_file);
  return client;
}

std::string other_way(const ConnectionArguments& arguments) try {
  if (!arguments.address.empty() || !arguments.token_file.empty()) return {};
  RpcEndpoint endpoint = read_endpoint(arguments.runtime_dir);
  if (endpoint.socket.empty()) return {};
  const Role by_socket = role_by(endpoint);
  endpoint.socket.clear();
  const Role by_port = role_by(endpoint);
  if (by_port <= by_socket) return {};
  return "; by the socket you have the role " + std::string(role_name(by_socket)) + " (see rpc.groups), by the port " +
         std::string(role_name(by_port)) + ": give --token-file or --address " + endpoint.text();
} catch (const std::exception&) {
  return {};  // the refusal itself is told
}

}  // namespace fvd::ctl
