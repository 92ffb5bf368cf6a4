#include "sim/modbus_tcp_server.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <list>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/error.hpp"

namespace fvd::sim {

namespace {

constexpr std::size_t kHeaderBytes = 7;  // transaction, protocol, length, unit
constexpr int kMaxRead = 125;
constexpr int kMaxWrite = 123;

using Bytes = std::vector<std::uint8_t>;

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

void append_word(Bytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
}

Bytes exception_reply(std::uint8_t function, ModbusException exception) {
  return {static_cast<std::uint8_t>(function | 0x80U), static_cast<std::uint8_t>(exception)};
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

struct Client {
  explicit Client(int fd) : socket(fd) {}
  FileDescriptor socket;
  Bytes input;
};

int listening_socket(const ModbusTcpOptions& options) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(options.port));
  const bool bound = ::inet_pton(AF_INET, options.address.c_str(), &address.sin_addr) == 1 &&
                     ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 &&
                     ::listen(fd, 8) == 0;
  if (bound) return fd;
  const std::string reason = std::strerror(errno);
  ::close(fd);
  throw Error(ErrorCode::kBadConfig, "the simulated drive cannot listen on " + options.address + ":" +
                                         std::to_string(options.port) + ": " + reason);
}

int bound_port(int fd) {
  sockaddr_in address{};
  socklen_t length = sizeof(address);
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

}  // namespace

struct ModbusTcpServer::Impl {
  Impl(RegisterBank& b, const ModbusTcpOptions& o)
      : bank(b),
        unit(o.unit),
        listener(listening_socket(o)),
        wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        port(bound_port(listener.get())),
        thread([this](std::stop_token stop) { serve(stop); }) {}

  ~Impl() {
    thread.request_stop();
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake.get(), &one, sizeof(one));
  }

  void serve(std::stop_token stop) {
    while (!stop.stop_requested()) {
      std::vector<pollfd> waiting{{wake.get(), POLLIN, 0}, {listener.get(), POLLIN, 0}};
      for (const Client& client : clients) waiting.push_back({client.socket.get(), POLLIN, 0});
      if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) return;
      std::size_t index = 2;
      for (auto client = clients.begin(); client != clients.end(); ++index) {
        const bool keep = waiting[index].revents == 0 || receive(*client, stop);
        client = keep ? std::next(client) : clients.erase(client);
      }
      if (waiting[1].revents != 0) accept_client();
    }
  }

  void accept_client() {
    const int fd = ::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC);
    if (fd < 0) return;
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    clients.emplace_back(fd);
  }

  /// False when the client is gone or talks nonsense.
  bool receive(Client& client, std::stop_token stop) {
    std::array<std::uint8_t, 1024> chunk{};
    const auto count = ::recv(client.socket.get(), chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (count <= 0) return count < 0 && (errno == EAGAIN || errno == EINTR);
    client.input.insert(client.input.end(), chunk.begin(), chunk.begin() + count);
    while (client.input.size() >= kHeaderBytes) {
      const std::size_t length = word_at(client.input, 4);
      if (word_at(client.input, 2) != 0 || length < 2 || length > 254) return false;
      if (client.input.size() < 6 + length) return true;
      const Bytes frame(client.input.begin(), client.input.begin() + static_cast<std::ptrdiff_t>(6 + length));
      client.input.erase(client.input.begin(), client.input.begin() + static_cast<std::ptrdiff_t>(6 + length));
      if (!answer(client, frame, stop)) return false;
    }
    return true;
  }

  bool take(std::atomic<int>& counter) {
    int left = counter.load();
    while (left > 0) {
      if (counter.compare_exchange_weak(left, left - 1)) return true;
    }
    return false;
  }

  bool answer(Client& client, const Bytes& frame, std::stop_token stop) {
    ++requests;
    const bool writes = frame[kHeaderBytes] != 3;
    if (mute || frame[6] != unit || (writes && take(lost_writes))) return true;
    const Bytes reply = execute(std::span(frame).subspan(kHeaderBytes));
    if (writes && take(lost_write_replies)) return true;
    if (take(delayed_replies)) {
      std::mutex mutex;
      std::condition_variable_any never;
      std::unique_lock lock(mutex);
      never.wait_for(lock, stop, std::chrono::milliseconds(delay_ms), [] { return false; });
    }
    Bytes message(frame.begin(), frame.begin() + 4);
    append_word(message, static_cast<unsigned>(reply.size() + 1));
    message.push_back(frame[6]);
    message.insert(message.end(), reply.begin(), reply.end());
    return ::send(client.socket.get(), message.data(), message.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(message.size());
  }

  Bytes execute(std::span<const std::uint8_t> pdu) {
    const std::uint8_t function = pdu[0];
    switch (function) {
      case 3:
        return pdu.size() == 5 ? read(function, word_at(pdu, 1), word_at(pdu, 3)) : bad_value(function);
      case 6:
        return pdu.size() == 5 ? write_one(pdu) : bad_value(function);
      case 16:
        return write_many(pdu);
      case 23:
        return read_write(pdu);
      default:
        return exception_reply(function, ModbusException::kIllegalFunction);
    }
  }

  static Bytes bad_value(std::uint8_t function) { return exception_reply(function, ModbusException::kIllegalValue); }

  Bytes read(std::uint8_t function, int address, int count) {
    if (count < 1 || count > kMaxRead) return bad_value(function);
    std::vector<std::uint16_t> values(static_cast<std::size_t>(count));
    const auto exception = bank.read(address, values);
    if (exception != ModbusException::kNone) return exception_reply(function, exception);
    Bytes reply{function, static_cast<std::uint8_t>(2 * count)};
    for (const auto value : values) append_word(reply, value);
    return reply;
  }

  Bytes write_one(std::span<const std::uint8_t> pdu) {
    const std::uint16_t value = word_at(pdu, 3);
    const auto exception = bank.write(word_at(pdu, 1), std::span(&value, 1));
    if (exception != ModbusException::kNone) return exception_reply(6, exception);
    return {pdu.begin(), pdu.end()};
  }

  /// The registers of a write whose byte count stands at `at`; empty if the counts disagree.
  static std::vector<std::uint16_t> words(std::span<const std::uint8_t> pdu, std::size_t at, int count) {
    std::vector<std::uint16_t> values;
    const auto bytes = static_cast<std::size_t>(2 * count);
    if (count < 1 || count > kMaxWrite || pdu.size() != at + 1 + bytes || pdu[at] != bytes) return values;
    for (std::size_t i = at + 1; i < pdu.size(); i += 2) values.push_back(word_at(pdu, i));
    return values;
  }

  Bytes write_many(std::span<const std::uint8_t> pdu) {
    if (pdu.size() < 6) return bad_value(16);
    const auto values = words(pdu, 5, word_at(pdu, 3));
    if (values.empty()) return bad_value(16);
    const auto exception = bank.write(word_at(pdu, 1), values);
    if (exception != ModbusException::kNone) return exception_reply(16, exception);
    return {pdu.begin(), pdu.begin() + 5};
  }

  Bytes read_write(std::span<const std::uint8_t> pdu) {
    if (pdu.size() < 10) return bad_value(23);
    const auto values = words(pdu, 9, word_at(pdu, 7));
    if (values.empty()) return bad_value(23);
    const auto exception = bank.write(word_at(pdu, 5), values);
    if (exception != ModbusException::kNone) return exception_reply(23, exception);
    return read(23, word_at(pdu, 1), word_at(pdu, 3));
  }

  RegisterBank& bank;
  int unit;
  FileDescriptor listener;
  FileDescriptor wake;
  int port;
  std::list<Client> clients;  // server thread only
  std::atomic<std::uint64_t> requests{0};
  std::atomic<bool> mute{false};
  std::atomic<int> delayed_replies{0};
  std::atomic<std::int64_t> delay_ms{0};
  std::atomic<int> lost_write_replies{0};
  std::atomic<int> lost_writes{0};
  std::jthread thread;  // last
};

ModbusTcpServer::ModbusTcpServer(RegisterBank& bank, const ModbusTcpOptions& options)
    : impl_(std::make_unique<Impl>(bank, options)) {}
ModbusTcpServer::~ModbusTcpServer() = default;

int ModbusTcpServer::port() const noexcept { return impl_->port; }
std::uint64_t ModbusTcpServer::requests() const noexcept { return impl_->requests; }
void ModbusTcpServer::set_mute(bool mute) { impl_->mute = mute; }
void ModbusTcpServer::delay_replies(int count, std::chrono::milliseconds delay) {
  impl_->delay_ms = delay.count();
  impl_->delayed_replies = count;
}
void ModbusTcpServer::lose_write_replies(int count) { impl_->lost_write_replies = count; }
void ModbusTcpServer::lose_writes(int count) { impl_->lost_writes = count; }

}  // namespace fvd::sim
