#include "sim/modbus/modbus_tcp_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <list>
#include <stop_token>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "sim/base/file_descriptor.hpp"
#include "sim/base/listening_socket.hpp"
#include "sim/modbus/scripted_responder.hpp"

namespace fvd::sim {

namespace {

constexpr std::size_t kHeaderBytes = 7;  // transaction, protocol, length, unit

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

struct Client {
  explicit Client(int fd) : socket(fd) {}
  FileDescriptor socket;
  ModbusBytes input;
};

enum class Connections { kKeep, kDropThis, kDropAll };

}  // namespace

struct ModbusTcpServer::Impl {
  Impl(RegisterBank& bank, const ModbusTcpOptions& options)
      : unit(options.unit),
        faults(options.faults != nullptr ? *options.faults : own_faults),
        responder(bank, &faults, options.drive),
        listener(listening_socket(options.address, options.port)),
        wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        port(bound_port(listener.get())),
        thread(start_thread("sim-modbus-tcp", [this](std::stop_token stop) { serve(stop); })) {}

  ~Impl() {
    thread.request_stop();
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake.get(), &one, sizeof(one));
  }

  void serve(std::stop_token stop) {
    while (!stop.stop_requested()) {
      std::vector<pollfd> waiting{{wake.get(), POLLIN, 0}, {listener.get(), POLLIN, 0}};
      for (const Client& client : clients) waiting.push_back({client.socket.get(), POLLIN, 0});
      if (::poll(waiting.data(), waiting.size(), RegisterBank::kIdlePeriodMs) < 0 && errno != EINTR) return;
      responder.idle();
      std::size_t index = 2;
      for (auto client = clients.begin(); client != clients.end(); ++index) {
        const auto fate = waiting[index].revents == 0 ? Connections::kKeep : receive(*client, stop);
        if (fate == Connections::kDropAll) {
          clients.clear();
          pause(outage, stop);
          break;
        }
        client = fate == Connections::kKeep ? std::next(client) : clients.erase(client);
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

  /// Drops a client that is gone or talks nonsense.
  Connections receive(Client& client, const std::stop_token& stop) {
    std::array<std::uint8_t, 1024> chunk{};
    const auto count = ::recv(client.socket.get(), chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return Connections::kKeep;
    if (count <= 0) return Connections::kDropThis;
    client.input.insert(client.input.end(), chunk.begin(), chunk.begin() + count);
    while (client.input.size() >= kHeaderBytes) {
      const std::size_t length = word_at(client.input, 4);
      if (word_at(client.input, 2) != 0 || length < 2 || length > 254) return Connections::kDropThis;
      if (client.input.size() < 6 + length) break;
      const auto end = client.input.begin() + static_cast<std::ptrdiff_t>(6 + length);
      const ModbusBytes frame(client.input.begin(), end);
      client.input.erase(client.input.begin(), end);
      const auto fate = answer(client, frame, stop);
      if (fate != Connections::kKeep) return fate;
    }
    return Connections::kKeep;
  }

  Connections answer(const Client& client, const ModbusBytes& frame, const std::stop_token& stop) {
    ++requests;
    if (mute || frame[6] != unit) return Connections::kKeep;
    const LineAnswer answer = responder.answer(std::span(frame).subspan(kHeaderBytes));
    if (answer.cut) {
      outage = answer.outage;
      return Connections::kDropAll;
    }
    if (answer.pdu.empty()) return Connections::kKeep;
    pause(answer.late, stop);
    ModbusBytes message(frame.begin(), frame.begin() + 4);
    if (answer.wrong_check) message[0] = static_cast<std::uint8_t>(message[0] ^ 0x55U);
    const std::size_t length = answer.pdu.size() + 1;
    message.push_back(static_cast<std::uint8_t>(length >> 8U));
    message.push_back(static_cast<std::uint8_t>(length & 0xFFU));
    message.push_back(frame[6]);
    message.insert(message.end(), answer.pdu.begin(), answer.pdu.end());
    if (answer.truncated) message.resize(message.size() / 2);
    const auto sent = ::send(client.socket.get(), message.data(), message.size(), MSG_NOSIGNAL);
    return sent == static_cast<ssize_t>(message.size()) ? Connections::kKeep : Connections::kDropThis;
  }

  static void pause(std::chrono::milliseconds duration, const std::stop_token& stop) {
    if (duration.count() == 0) return;
    Mutex mutex;
    Condition never;
    MutexLock lock(mutex);
    never.wait_for(lock, stop, duration, [] { return false; });
  }

  int unit;
  FaultScript own_faults;
  FaultScript& faults;
  ScriptedResponder responder;  // server thread only, as clients and outage
  FileDescriptor listener;
  FileDescriptor wake;
  int port;
  std::list<Client> clients;
  std::chrono::milliseconds outage{0};
  std::atomic<std::uint64_t> requests{0};
  std::atomic<bool> mute{false};
  std::jthread thread;  // last
};

ModbusTcpServer::ModbusTcpServer(RegisterBank& bank, const ModbusTcpOptions& options)
    : impl_(std::make_unique<Impl>(bank, options)) {}
ModbusTcpServer::~ModbusTcpServer() = default;

int ModbusTcpServer::port() const noexcept { return impl_->port; }
std::uint64_t ModbusTcpServer::requests() const noexcept { return impl_->requests; }
void ModbusTcpServer::set_mute(bool mute) { impl_->mute = mute; }
void ModbusTcpServer::delay_replies(int count, std::chrono::milliseconds delay) {
  impl_->faults.add({.count = count, .fault = FaultKind::kLateReply, .delay = delay});
}
void ModbusTcpServer::lose_write_replies(int count) {
  impl_->faults.add({.on = FaultOn::kWrite, .count = count, .fault = FaultKind::kLostReply});
}
void ModbusTcpServer::lose_writes(int count) {
  impl_->faults.add({.on = FaultOn::kWrite, .count = count, .fault = FaultKind::kLostRequest});
}

}  // namespace fvd::sim
