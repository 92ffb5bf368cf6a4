/// Answers to the driver's Modbus requests over TCP, of a server that sends what the input says: first the request,
/// then how the answer is framed, then its bytes. All is in one thread: the answer lies there before the request is
/// sent.

#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include "drivers/modbus/modbus_transport.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

namespace {

/// Listens on a port of its own; connections to it are made without anybody's doing.
class Listener {
 public:
  Listener() : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof own;
    auto* const address = reinterpret_cast<sockaddr*>(&own);
    require(::bind(fd_, address, length) == 0 && ::listen(fd_, 1) == 0 && ::getsockname(fd_, address, &length) == 0);
    port_ = ntohs(own.sin_port);
  }
  ~Listener() { ::close(fd_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] int accept() const { return ::accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC); }

 private:
  int fd_;
  int port_ = 0;
};

ModbusRequest request_of(InputReader& input) {
  ModbusRequest request;
  const std::uint8_t kind = input.byte();
  const bool writes = (kind & 4U) != 0;
  // Inputs of the device cannot be written.
  request.table = static_cast<ModbusTable>(writes ? (kind & 1U) * 2 : kind & 3U);
  request.single = (kind & 8U) != 0;
  request.address = input.word();
  const int count = input.byte() % 120 + 1;
  if (writes) {
    request.written.assign(static_cast<std::size_t>(count), 1);
  } else {
    request.read_count = count;
  }
  return request;
}

/// Behind the header that belongs to the first request of a connection, or as it is.
std::string answer_of(InputReader& input) {
  const std::uint8_t framing = input.byte();
  const auto bytes = input.rest();
  std::string answer;
  if ((framing & 1U) == 0) {
    const std::size_t length = bytes.size() + 1;
    answer = {0, 1, 0, 0, static_cast<char>(length >> 8U), static_cast<char>(length), 1};
  }
  return answer.append(text_of(bytes));
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  using namespace fvd::test;
  spdlog::set_level(spdlog::level::off);
  static const Listener listener;
  InputReader input({bytes, size});
  const ModbusRequest request = request_of(input);
  const std::string answer = answer_of(input);

  ModbusTransport transport({.endpoint = ModbusTcpEndpoint{"127.0.0.1", listener.port()}});
  bool renewed = false;
  std::string error;
  require(transport.ensure_connected(request.writes(), renewed, error) && renewed);
  const int peer = listener.accept();
  require(peer >= 0);
  (void)::send(peer, answer.data(), answer.size(), MSG_NOSIGNAL);
  ::shutdown(peer, SHUT_WR);
  std::vector<std::uint16_t> values;
  const PduAnswer judged = transport.transact(request, values, error);
  require((judged == PduAnswer::kOk) == error.empty());
  if (judged == PduAnswer::kOk) require(values.size() == static_cast<std::size_t>(request.read_count));
  if (judged == PduAnswer::kNone) transport.resynchronise([] { return true; });
  // Reset, not closed: ports that wait for late packets would run out.
  const linger at_once{1, 0};
  ::setsockopt(peer, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  ::close(peer);
  return 0;
}
