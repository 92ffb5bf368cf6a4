#include "sim/camera/gvsp.hpp"

#include <algorithm>

#include "sim/camera/gvcp.hpp"

namespace fvd::sim::gvsp {

namespace {

constexpr int kIpAndUdpBytes = 20 + 8;
constexpr std::uint32_t kLeader = 1;
constexpr std::uint32_t kTrailer = 2;
constexpr std::uint32_t kPayload = 3;
constexpr std::uint32_t kExtendedIds = 0x80000000U;
constexpr unsigned kPayloadTypeImage = 1;

std::size_t room(const StreamFrame& frame) {
  return static_cast<std::size_t>(frame.packet_size - header_bytes(frame.extended_ids));
}

}  // namespace

int header_bytes(bool extended_ids) { return kIpAndUdpBytes + (extended_ids ? 20 : 8); }

std::uint32_t trailer_id(const StreamFrame& frame) {
  return static_cast<std::uint32_t>((frame.pixels.size() + room(frame) - 1) / room(frame)) + 1;
}

std::vector<std::uint8_t> head(const StreamFrame& frame, std::uint32_t packet) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(64);
  const std::uint32_t type = packet == 0 ? kLeader : packet == trailer_id(frame) ? kTrailer : kPayload;
  gvcp::put16(bytes, 0);
  if (frame.extended_ids) {
    gvcp::put16(bytes, 0);
    gvcp::put32(bytes, kExtendedIds | (type << 24U));
    gvcp::put32(bytes, static_cast<std::uint32_t>(frame.block_id >> 32U));
    gvcp::put32(bytes, static_cast<std::uint32_t>(frame.block_id & 0xFFFFFFFFU));
    gvcp::put32(bytes, packet);
  } else {
    gvcp::put16(bytes, static_cast<unsigned>(frame.block_id));
    gvcp::put32(bytes, (type << 24U) | packet);
  }
  if (type == kLeader) {
    gvcp::put16(bytes, 0);
    gvcp::put16(bytes, kPayloadTypeImage);
    gvcp::put32(bytes, static_cast<std::uint32_t>(frame.timestamp_ns >> 32U));
    gvcp::put32(bytes, static_cast<std::uint32_t>(frame.timestamp_ns & 0xFFFFFFFFU));
    for (const auto value : {frame.pfnc, frame.width, frame.height, frame.offset_x, frame.offset_y, 0U}) {
      gvcp::put32(bytes, value);
    }
  } else if (type == kTrailer) {
    gvcp::put32(bytes, kPayloadTypeImage);
    gvcp::put32(bytes, frame.height);
  }
  return bytes;
}

std::span<const std::byte> body(const StreamFrame& frame, std::uint32_t packet) {
  if (packet == 0 || packet >= trailer_id(frame)) return {};
  const std::size_t begin = (packet - 1) * room(frame);
  return std::span(frame.pixels).subspan(begin, std::min(room(frame), frame.pixels.size() - begin));
}

}  // namespace fvd::sim::gvsp
