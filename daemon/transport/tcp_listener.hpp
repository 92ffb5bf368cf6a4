#pragma once

/// How a server of the daemon begins to listen.

#include <string>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/ip/tcp.hpp>

namespace fvd {

/// Opens, binds and listens; port 0: any free one. section: where address and port stand in the configuration, as
/// "/rpc"; errors name it. Throws Error kBadConfig if the address is none, kNotReady if it cannot be had now: another
/// program may give the port free, and a network card may get its address later.
void listen_on(boost::asio::ip::tcp::acceptor& acceptor, const std::string& address, int port,
               const std::string& section);

}  // namespace fvd
