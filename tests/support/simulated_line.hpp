#pragma once

/// A bank of registers served on Modbus TCP or on a pseudo-terminal, and the link configuration that reaches it.

#include <chrono>
#include <memory>
#include <ostream>

#include "drivers/modbus/modbus_transport.hpp"
#include "sim/modbus/modbus_rtu_server.hpp"
#include "sim/modbus/modbus_tcp_server.hpp"

namespace fvd::test {

enum class Transport { kTcp, kRtu };

inline std::ostream& operator<<(std::ostream& out, Transport transport) {
  return out << (transport == Transport::kTcp ? "Tcp" : "Rtu");
}

class SimulatedLine {
 public:
  SimulatedLine(Transport transport, sim::RegisterBank& bank, sim::FaultScript& faults,
                sim::DriveFaults* drive = nullptr, const sim::LineTiming& timing = {})
      : transport_(transport), bank_(bank), faults_(faults), drive_(drive), timing_(timing) {
    serve();
  }

  void serve() {
    if (transport_ == Transport::kTcp) {
      tcp_ = std::make_unique<sim::ModbusTcpServer>(
          bank_, sim::ModbusTcpOptions{.port = port_, .faults = &faults_, .drive = drive_});
      port_ = tcp_->port();
    } else {
      rtu_ = std::make_unique<sim::ModbusRtuServer>(
          bank_, sim::ModbusRtuOptions{.timing = timing_, .faults = &faults_, .drive = drive_});
    }
  }

  void set_mute(bool mute) {
    if (tcp_) tcp_->set_mute(mute);
    if (rtu_) rtu_->set_mute(mute);
  }

  [[nodiscard]] ModbusLinkConfig config(std::chrono::milliseconds response_timeout = std::chrono::milliseconds(150),
                                        std::chrono::milliseconds quiet = std::chrono::milliseconds(250)) const {
    ModbusLinkConfig config;
    if (tcp_) {
      config.endpoint = ModbusTcpEndpoint{"127.0.0.1", tcp_->port()};
    } else {
      config.endpoint = ModbusSerialEndpoint{rtu_->path().string(), 115200, 'E', 1};
    }
    config.response_timeout = response_timeout;
    config.quiet = quiet;
    return config;
  }

 private:
  Transport transport_;
  sim::RegisterBank& bank_;
  sim::FaultScript& faults_;
  sim::DriveFaults* drive_;
  sim::LineTiming timing_;
  int port_ = 0;
  std::unique_ptr<sim::ModbusTcpServer> tcp_;
  std::unique_ptr<sim::ModbusRtuServer> rtu_;
};

}  // namespace fvd::test
