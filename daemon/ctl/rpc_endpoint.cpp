#include "daemon/ctl/rpc_endpoint.hpp"

#include <charconv>
#include <fstream>
#include <system_error>

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"

namespace fvd::ctl {

std::string RpcEndpoint::text() const {
  if (!socket.empty()) return socket;
  const bool ipv6 = host.find(':') != std::string::npos;
  return (ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

RpcEndpoint parse_endpoint(std::string_view whole_text) {
  constexpr std::string_view kHttp = "http://";
  RpcEndpoint endpoint;
  endpoint.is_http = whole_text.starts_with(kHttp);
  std::string_view text = whole_text.substr(endpoint.is_http ? kHttp.size() : 0);
  if (endpoint.is_http && text.ends_with('/')) text.remove_suffix(1);
  if (text.starts_with("https://")) {
    throw Error(ErrorCode::kBadInput, "fvdctl speaks no TLS: give http:// or host:port, through a tunnel if need be");
  }
  const auto colon = text.rfind(':');
  if (colon != std::string_view::npos) {
    std::string_view host = text.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    const std::string_view port = text.substr(colon + 1);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
    const bool is_number = error == std::errc() && end == port.data() + port.size();
    if (is_number && !host.empty() && endpoint.port >= 1 && endpoint.port <= 65535) {
      endpoint.host = host;
      return endpoint;
    }
  }
  throw Error(ErrorCode::kBadInput,
              "address '" + std::string(whole_text) + "' is not host:port or http://host:port with a port of 1..65535");
}

RpcEndpoint read_endpoint(const std::filesystem::path& runtime_dir) {
  const auto path = runtime_dir / "rpc.json";
  std::ifstream file(path);
  if (!file) {
    throw Error(ErrorCode::kNotReady, "cannot read " + path.string() +
                                          ", where fvd says on which port it listens: is fvd running? Give --address "
                                          "host:port or --runtime-dir if it runs elsewhere");
  }
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (json.is_object() && json.contains("address") && json["address"].is_string() && json.contains("port") &&
      json["port"].is_number_integer()) {
    RpcEndpoint endpoint{json["address"].get<std::string>(), json["port"].get<int>()};
    std::error_code ignored;
    if (const auto socket = json.find("socket"); socket != json.end() && socket->is_string()) {
      auto socket_file = socket->get<std::string>();
      if (std::filesystem::is_socket(socket_file, ignored)) endpoint.socket = std::move(socket_file);
    }
    if (endpoint.port >= 1 && endpoint.port <= 65535) return endpoint;
  }
  throw Error(ErrorCode::kBadInput, path.string() + " is not of the form {\"address\": \"127.0.0.1\", \"port\": 7411}");
}

}  // namespace fvd::ctl
