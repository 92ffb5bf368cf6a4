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
constexpr std::size_t kForceIpBytes = 56;
/// Requests whose repetition is recognised.
constexpr std::size_t kRemembered = 16;

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

std::vector<std::uint8_t> pending(std::uint16_t request, int promised_ms) {
  std::vector<std::uint8_t> message;
  gvcp::put16(message, static_cast<unsigned>(Status::kSuccess));
  gvcp::put16(message, gvcp::kPendingAcknowledge);
  gvcp::put16(message, 4);
  gvcp::put16(message, request);
  gvcp::put16(message, 0);
  gvcp::put16(message, static_cast<unsigned>(std::min(promised_ms, 0xFFFF)));
  return message;
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
  for (const auto at : {reg::kControlPrivilege, reg::kPrimaryPort, reg::kPrimaryAddress}) registers_.set(at, 0);
  registers_.set(reg::kStreamPort, 0);
  registers_.set(feature::kParametersLocked, 0);
  streamer_.set_acquiring(false);
}

void GigeControl::restart() {
  release_control();
  registers_.reset();
  sender_.forget();
  done_.clear();
  (void)look_for_address();  // one that cannot be had is not taken
}

std::vector<std::uint8_t> GigeControl::answer_broadcast(GvcpPeer peer, std::span<const std::uint8_t> packet) {
  if (packet.size() < gvcp::kHeaderBytes) return {};
  const std::uint16_t code = gvcp::get16(packet, 2);
  const bool concerns_all =
      code == static_cast<std::uint16_t>(Command::kDiscovery) || code == static_cast<std::uint16_t>(Command::kForceIp);
  return concerns_all ? answer(peer, packet).acknowledge : std::vector<std::uint8_t>{};
}

GvcpReply GigeControl::answer(GvcpPeer peer, std::span<const std::uint8_t> packet) {
  if (packet.size() < gvcp::kHeaderBytes || packet[0] != kKey) return {};
  const std::uint16_t code = gvcp::get16(packet, 2);
  const std::uint16_t request = gvcp::get16(packet, 6);
  if (gvcp::get16(packet, 4) != packet.size() - gvcp::kHeaderBytes) return {};
  const bool from_controller = controller_ == peer;
  if (from_controller) last_heard_ = HostClock::now();
  const auto before = std::find_if(done_.begin(), done_.end(), [&](const Done& done) {
    return done.peer == peer && std::equal(done.packet.begin(), done.packet.end(), packet.begin(), packet.end());
  });
  if (before != done_.end()) return {.acknowledge = before->acknowledge};
  if (code == static_cast<std::uint16_t>(Command::kPacketResend)) {
    resend(packet.subspan(gvcp::kHeaderBytes));
    return {};
  }
  const auto fault = from_controller ? faults_.next(CameraEvent::kCommand) : std::nullopt;
  if (fault && strikes_anywhere(fault->fault)) {
    struck_(*fault);
    if (fault->fault != CameraFault::kClockStep && fault->fault != CameraFault::kChunkMode) return {};
  }
  const bool busy = fault && fault->fault == CameraFault::kBusy;
  // Of an address that is given to another camera nobody hears here.
  if (code == static_cast<std::uint16_t>(Command::kForceIp) && !is_meant(packet.subspan(gvcp::kHeaderBytes))) return {};
  GvcpReply reply;
  reply.acknowledge = busy ? acknowledge(Status::kBusy, code, request, {}) : execute(peer, packet);
  done_.push_back({peer, {packet.begin(), packet.end()}, reply.acknowledge});
  if (done_.size() > kRemembered) done_.pop_front();
  if (fault && fault->fault == CameraFault::kPendingAck) {
    const auto promised = fault->value != 0 ? fault->value : static_cast<int>(fault->delay.count());
    reply.pending = pending(request, promised);
    reply.delay = fault->delay;
    last_heard_ += fault->delay;  // a client that waits for the answer sends no heartbeat
  }
  const bool dropped = fault && fault->fault == CameraFault::kDropAck;
  if (dropped || (packet[1] & kAcknowledgeWanted) == 0) return {};
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
    case Command::kForceIp:
      status = force_ip(payload);
      break;
    case Command::kPacketResend:  // has no acknowledge, and does not come here
      break;
    case Command::kReadRegister:
      status = read_registers(peer, payload, data);
      break;
    case Command::kReadMemory:
      status = read_memory(peer, payload, data);
      break;
    case Command::kWriteRegister:
      status = write_registers(peer, payload, data);
      break;
    case Command::kWriteMemory:
      status = write_memory(peer, payload, data);
      break;
  }
  // A refused write says how far it came, a refused read says nothing.
  const bool writes = code == static_cast<std::uint16_t>(Command::kWriteRegister) ||
                      code == static_cast<std::uint16_t>(Command::kWriteMemory);
  if (status != Status::kSuccess && !writes) data.clear();
  return acknowledge(status, code, gvcp::get16(packet, 6), data);
}

bool GigeControl::is_meant(std::span<const std::uint8_t> payload) const {
  return payload.size() == kForceIpBytes && gvcp::get16(payload, 2) == registers_.get(reg::kMacHigh) &&
         gvcp::get32(payload, 4) == registers_.get(reg::kMacLow);
}

Status GigeControl::force_ip(std::span<const std::uint8_t> payload) {
  const std::uint32_t address = gvcp::get32(payload, 20);
  return address == 0 ? look_for_address() : take_address(address, gvcp::get32(payload, 36), gvcp::get32(payload, 52));
}

Status GigeControl::look_for_address() {
  const std::uint32_t address = registers_.get(reg::kPersistentIpAddress);
  const bool persistent = (registers_.get(reg::kIpConfigCurrent) & gvcp::ip_config::kPersistent) != 0;
  // Nobody gives addresses on loopback: without one of its own the camera keeps what it has.
  if (!persistent || address == 0) return Status::kSuccess;
  return take_address(address, registers_.get(reg::kPersistentSubnetMask), registers_.get(reg::kPersistentGateway));
}

Status GigeControl::take_address(std::uint32_t address, std::uint32_t mask, std::uint32_t gateway) {
  if (address != registers_.get(reg::kIpAddress) && !move_(address)) return Status::kInvalidParameter;
  release_control();
  registers_.set(reg::kIpAddress, address);
  registers_.set(reg::kSubnetMask, mask);
  registers_.set(reg::kGateway, gateway);
  registers_.set(reg::kStreamSourcePort, static_cast<std::uint32_t>(sender_.source_port()));
  return Status::kSuccess;
}

void GigeControl::resend(std::span<const std::uint8_t> payload) {
  if (payload.size() < 12) return;
  std::uint64_t block = gvcp::get16(payload, 2);
  std::uint32_t mask = 0xFFFFFFU;
  if (payload.size() >= 20) {  // extended ids
    block = (std::uint64_t{gvcp::get32(payload, 12)} << 32U) | gvcp::get32(payload, 16);
    mask = 0xFFFFFFFFU;
  }
  const CameraState state = registers_.state();
  sender_.resend({.block_id = block,
                  .first = gvcp::get32(payload, 4) & mask,
                  .last = gvcp::get32(payload, 8) & mask,
                  .extended_ids = payload.size() >= 20,
                  .to_address = state.stream_address,
                  .to_port = state.stream_port});
}

bool GigeControl::may_read(GvcpPeer peer, std::uint32_t at) const {
  const bool exclusive = (registers_.get(reg::kControlPrivilege) & gvcp::privilege::kExclusive) != 0;
  return !exclusive || controller_ == peer || at == reg::kControlPrivilege;
}

Status GigeControl::read_registers(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data) {
  if (!fits(payload, 4)) return Status::kInvalidParameter;
  for (std::size_t at = 0; at < payload.size(); at += 4) {
    if (!may_read(peer, gvcp::get32(payload, at))) return Status::kAccessDenied;
    std::array<std::uint8_t, 4> value{};
    const Status status = registers_.read(gvcp::get32(payload, at), value);
    if (status != Status::kSuccess) return status;
    data.insert(data.end(), value.begin(), value.end());
  }
  return Status::kSuccess;
}

Status GigeControl::read_memory(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data) {
  if (payload.size() != 8) return Status::kInvalidParameter;
  const std::uint32_t from = gvcp::get32(payload, 0);
  const std::uint16_t count = gvcp::get16(payload, 6);
  if (count == 0 || count > kMaxMemory) return Status::kInvalidParameter;
  if (from % 4 != 0 || count % 4 != 0) return Status::kBadAlignment;
  if (!may_read(peer, from)) return Status::kAccessDenied;
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
  const Status status = write(peer, gvcp::get32(payload, 0), payload.subspan(4));
  gvcp::put16(data, 0);
  gvcp::put16(data, status == Status::kSuccess ? static_cast<unsigned>(payload.size() - 4) : 0);
  return status;
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
  if ((value & ~(gvcp::privilege::kExclusive | gvcp::privilege::kControl)) != 0) return Status::kInvalidParameter;
  controller_ = peer;
  last_heard_ = HostClock::now();
  registers_.set(reg::kControlPrivilege, value);
  registers_.set(reg::kPrimaryPort, peer.port);
  registers_.set(reg::kPrimaryAddress, peer.address);
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
      registers_.set(reg::kStreamPacketSize, value & ~gvcp::kFireTestPacket);
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
