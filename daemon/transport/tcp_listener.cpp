#include "daemon/transport/tcp_listener.hpp"

#include "core/base/error.hpp"

namespace fvd {

namespace asio = boost::asio;
using asio::ip::tcp;

void listen_on(tcp::acceptor& acceptor, const std::string& address, int port, const std::string& section) {
  boost::system::error_code error;
  const auto refuse = [&](ErrorCode code) {
    throw Error(code, "cannot listen on " + address + ":" + std::to_string(port) + ": " + error.message() + "; see " +
                          section + "/address and " + section + "/port");
  };
  const auto ip = asio::ip::make_address(address, error);
  if (error) refuse(ErrorCode::kBadConfig);
  const tcp::endpoint endpoint(ip, static_cast<unsigned short>(port));
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) refuse(ErrorCode::kNotReady);
}

}  // namespace fvd
