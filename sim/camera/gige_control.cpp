#include "sim/camera/gige_control.hpp"

#include <algorithm>
#include <array>

namespace fvd::sim {

namespace {

using gvcp::Command;
using gvcp::Status;
namespace reg = gvcp::reg;

constexpr std::uint8_t kKey = 0x42;
constexpr std::uint8_t kAcknowledgeWanted = 0x01;
constexpr std::size_t kMaxMemory = 536;

std::vector<std::uint8_t> acknowledge(Status status, std::uint16_t code, std::uint16_t request,
                                      const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> reply;
  gvcp::put16(reply, static_cast<unsigned>(status));
  gvcp::put16(reply, code + 1U);
  gvcp::put16(reply, static_cast<unsigned>(payload.size()));
  gvcp::put16(reply, request);
  reply.insert(reply.end(), payload.begin(), payload.end());
  return reply;
}

bool fits(std::span<const std::uint8_t> payload, std::size_t unit) {
  return !payload.empty() && payload.size() % unit == 0 && payload.size() <= gvcp::kMaxPayload;
}

}  // namespace

void GigeControl::check_heartbeat() {
  if (!controller_) return;
  const auto timeout = std::chrono::milliseconds(registers_.get(reg::kHeartbeatTimeout));
  if (HostClock::now() - last_heard_ > timeout) release_control();
}

void GigeControl::release_control() {
  controller_.reset();
  registers_.set(reg::kControlPrivilege, 0);
  registers_.set(reg::kStreamPort, 0);
  registers_.set(feature::kParametersLocked, 0);
  streamer_.set_acquiring(false);
}

void GigeControl::restart() {
  release_control();
  registers_.reset();
  sender_.forget();
  last_peer_.reset();
}

std::vector<std::uint8_t> GigeControl::answer(GvcpPeer peer, std::span<const std::uint8_t> packet) {
  if (packet.size() < gvcp::kHeaderBytes || packet[0] != kKey) return {};
  const std::uint16_t code = gvcp::get16(packet, 2);
  const std::uint16_t request = gvcp::get16(packet, 6);
  if (gvcp::get16(packet, 4) != packet.size() - gvcp::kHeaderBytes) return {};
  const bool from_controller = controller_ == peer;
  if (from_controller) last_heard_ = HostClock::now();
  if (last_peer_ == peer && last_request_ == request && last_code_ == code) return last_reply_;
  const auto fault = from_controller && code != static_cast<std::uint16_t>(Command::kPacketResend)
                         ? faults_.next(CameraEvent::kCommand)
                         : std::nullopt;
  if (fault && fault->fault != CameraFault::kDropAck) {
    struck_(*fault);
    return {};
  }
  Bytes reply = execute(peer, packet);
  if (code != static_cast<std::uint16_t>(Command::kPacketResend)) {
    last_peer_ = peer;
    last_request_ = request;
    last_code_ = code;
    last_reply_ = reply;
  }
  if (fault || (packet[1] & kAcknowledgeWanted) == 0) return {};
  return reply;
}

std::vector<std::uint8_t> GigeControl::execute(GvcpPeer peer, std::span<const std::uint8_t> packet) {
  const std::uint16_t code = gvcp::get16(packet, 2);
  const auto payload = packet.subspan(gvcp::kHeaderBytes);
  Bytes data;
  Status status = Status::kNotImplemented;
  switch (static_cast<Command>(code)) {
    case Command::kDiscovery:
      data.resize(reg::kDiscoveryBytes);
      status = registers_.read(0, data);
      break;
    case Command::kPacketResend:
      resend(payload);
      return {};
    case Command::kReadRegister:
      status = read_registers(payload, data);
      break;
    case Command::kReadMemory:
      status = read_memory(payload, data);
      break;
    case Command::kWriteRegister:
      status = write_registers(peer, payload, data);
      break;
    case Command::kWriteMemory:
      status = write_memory(peer, payload, data);
      break;
  }
  if (status != Status::kSuccess) data.clear();
  return acknowledge(status, code, gvcp::get16(packet, 6), data);
}

void GigeControl::resend(std::span<const std::uint8_t> payload) {
  if (payload.size() < 12) return;
  std::uint64_t block = gvcp::get16(payload, 2);
  std::uint32_t mask = 0xFFFFFFU;
  if (payload.size() >= 20) {  // extended ids
    block = (std::uint64_t{gvcp::get32(payload, 12)} << 32U) | gvcp::get32(payload, 16);
    mask = 0xFFFFFFFFU;
  }
  sender_.resend(block, gvcp::get32(payload, 4) & mask, gvcp::get32(payload, 8) & mask);
}

Status GigeControl::read_registers(std::span<const std::uint8_t> payload, Bytes& data) {
  if (!fits(payload, 4)) return Status::kInvalidParameter;
  for (std::size_t at = 0; at < payload.size(); at += 4) {
    std::array<std::uint8_t, 4> value{};
    const Status status = registers_.read(gvcp::get32(payload, at), value);
    if (status != Status::kSuccess) return status;
    data.insert(data.end(), value.begin(), value.end());
  }
  return Status::kSuccess;
}

Status GigeControl::read_memory(std::span<const std::uint8_t> payload, Bytes& data) {
  if (payload.size() != 8) return Status::kInvalidParameter;
  const std::uint32_t from = gvcp::get32(payload, 0);
  const std::uint16_t count = gvcp::get16(payload, 6);
  if (count == 0 || count > kMaxMemory) return Status::kInvalidParameter;
  if (from % 4 != 0 || count % 4 != 0) return Status::kBadAlignment;
  data.resize(4U + count);
  std::copy_n(payload.begin(), 4, data.begin());
  return registers_.read(from, std::span(data).subspan(4));
}

Status GigeControl::write_registers(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data) {
  if (!fits(payload, 8)) return Status::kInvalidParameter;
  Status status = Status::kSuccess;
  unsigned written = 0;
  for (std::size_t at = 0; at < payload.size() && status == Status::kSuccess; at += 8) {
    status = write(peer, gvcp::get32(payload, at), payload.subspan(at + 4, 4));
    if (status == Status::kSuccess) ++written;
  }
  gvcp::put16(data, 0);
  gvcp::put16(data, written);
  return status;
}

Status GigeControl::write_memory(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data) {
  if (payload.size() < 8 || !fits(payload, 4)) return Status::kInvalidParameter;
  gvcp::put16(data, 0);
  gvcp::put16(data, static_cast<unsigned>(payload.size() - 4));
  return write(peer, gvcp::get32(payload, 0), payload.subspan(4));
}

Status GigeControl::write(GvcpPeer peer, std::uint32_t at, std::span<const std::uint8_t> bytes) {
  if (at == reg::kControlPrivilege && bytes.size() == 4) return write_privilege(peer, gvcp::get32(bytes, 0));
  if (controller_ != peer) return Status::kAccessDenied;
  const Status status = registers_.write(at, bytes);
  if (status != Status::kSuccess) return status;
  streamer_.look_again();
  return bytes.size() == 4 ? act_on(at, gvcp::get32(bytes, 0)) : status;
}

Status GigeControl::write_privilege(GvcpPeer peer, std::uint32_t value) {
  if (controller_ && controller_ != peer) return Status::kAccessDenied;
  if (value == 0) {
    release_control();
    return Status::kSuccess;
  }
  controller_ = peer;
  last_heard_ = HostClock::now();
  registers_.set(reg::kControlPrivilege, value);
  return Status::kSuccess;
}

Status GigeControl::act_on(std::uint32_t at, std::uint32_t value) {
  switch (at) {
    case feature::kAcquisitionStart:
      streamer_.set_acquiring(true);
      break;
    case feature::kAcquisitionStop:
      streamer_.set_acquiring(false);
      break;
    case feature::kTriggerSoftware:
      return streamer_.trigger(false) ? Status::kSuccess : Status::kBusy;
    case reg::kTimestampControl: {
      const auto now = streamer_.timestamp_ns(HostClock::now());
      registers_.set(reg::kTimestampHigh, static_cast<std::uint32_t>(now >> 32U));
      registers_.set(reg::kTimestampLow, static_cast<std::uint32_t>(now & 0xFFFFFFFFU));
      break;
    }
    case reg::kStreamPacketSize: {
      if ((value & gvcp::kFireTestPacket) == 0) break;
      const CameraState state = registers_.state();
      sender_.send_test_packet(state.stream_address, state.stream_port, state.packet_size);
      break;
    }
    default:
      break;
  }
  return Status::kSuccess;
}

}  // namespace fvd::sim
