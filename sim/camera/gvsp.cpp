#include "sim/camera/gvsp.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "sim/camera/gvcp.hpp"

namespace fvd::sim::gvsp {

namespace {

constexpr int kIpAndUdpBytes = 20 + 8;
constexpr std::uint32_t kLeader = 1;
constexpr std::uint32_t kTrailer = 2;
constexpr std::uint32_t kPayload = 3;
constexpr std::uint32_t kExtendedIds = 0x80000000U;
constexpr unsigned kPayloadTypeImage = 1;
constexpr unsigned kPayloadTypeChunks = 4;
constexpr unsigned kPayloadTypeImageWithChunks = 0x4001;
constexpr unsigned kPacketUnavailable = 0x800C;
/// The image's; number, time in ns and exposure in us as a 64-bit float have the next ones.
constexpr std::uint32_t kImageChunk = 1;
constexpr std::uint32_t kChunkLayout = 0;
constexpr std::size_t kChunkTrailerBytes = 8;
constexpr std::uint32_t kWideBytes = 8;

std::size_t room(const StreamFrame& frame) {
  return static_cast<std::size_t>(frame.packet_size - header_bytes(frame.extended_ids));
}

unsigned payload_type(ChunkMode chunks) {
  switch (chunks) {
    case ChunkMode::kExtended:
      return kPayloadTypeImageWithChunks;
    case ChunkMode::kPlain:
      return kPayloadTypeChunks;
    case ChunkMode::kOff:
      break;
  }
  return kPayloadTypeImage;
}

void put64(std::vector<std::uint8_t>& bytes, std::uint64_t value) {
  gvcp::put32(bytes, static_cast<std::uint32_t>(value >> 32U));
  gvcp::put32(bytes, static_cast<std::uint32_t>(value & 0xFFFFFFFFU));
}

std::vector<std::uint8_t> header(unsigned status, std::uint64_t block_id, bool extended_ids, std::uint32_t type,
                                 std::uint32_t packet) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(64);
  gvcp::put16(bytes, status);
  if (extended_ids) {
    gvcp::put16(bytes, 0);
    gvcp::put32(bytes, kExtendedIds | (type << 24U));
    put64(bytes, block_id);
    gvcp::put32(bytes, packet);
  } else {
    gvcp::put16(bytes, static_cast<unsigned>(block_id));
    gvcp::put32(bytes, (type << 24U) | packet);
  }
  return bytes;
}

}  // namespace

int header_bytes(bool extended_ids) { return kIpAndUdpBytes + (extended_ids ? 20 : 8); }

std::uint32_t trailer_id(const StreamFrame& frame) {
  return static_cast<std::uint32_t>((frame.pixels.size() + room(frame) - 1) / room(frame)) + 1;
}

std::vector<std::uint8_t> head(const StreamFrame& frame, std::uint32_t packet) {
  const std::uint32_t type = packet == 0 ? kLeader : packet == trailer_id(frame) ? kTrailer : kPayload;
  std::vector<std::uint8_t> bytes = header(0, frame.block_id, frame.extended_ids, type, packet);
  const bool geometry = frame.chunks != ChunkMode::kPlain;
  if (type == kLeader) {
    gvcp::put32(bytes, payload_type(frame.chunks));
    put64(bytes, frame.timestamp_ns);
    if (!geometry) return bytes;
    for (const auto value :
         {frame.pfnc, frame.width, frame.height, frame.offset_x, frame.offset_y, frame.x_padding << 16U}) {
      gvcp::put32(bytes, value);
    }
  } else if (type == kTrailer) {
    gvcp::put32(bytes, payload_type(frame.chunks));
    if (geometry) gvcp::put32(bytes, frame.height);
    if (frame.chunks != ChunkMode::kOff) gvcp::put32(bytes, static_cast<std::uint32_t>(frame.pixels.size()));
    if (frame.chunks == ChunkMode::kExtended) gvcp::put32(bytes, kChunkLayout);
  }
  return bytes;
}

std::vector<std::uint8_t> unavailable(std::uint64_t block_id, bool extended_ids, std::uint32_t packet) {
  return header(kPacketUnavailable, block_id, extended_ids, kPayload, packet);
}

std::size_t chunk_bytes() { return 4 * kChunkTrailerBytes + 3 * kWideBytes; }

void append_chunks(StreamFrame& frame, double exposure_us) {
  std::vector<std::uint8_t> bytes;
  gvcp::put32(bytes, kImageChunk);
  gvcp::put32(bytes, static_cast<std::uint32_t>(frame.pixels.size()));
  const std::array<std::uint64_t, 3> values{frame.block_id, frame.timestamp_ns,
                                            std::bit_cast<std::uint64_t>(exposure_us)};
  std::uint32_t id = kImageChunk;
  for (const std::uint64_t value : values) {
    put64(bytes, value);
    gvcp::put32(bytes, ++id);
    gvcp::put32(bytes, kWideBytes);
  }
  const auto raw = std::as_bytes(std::span(bytes));
  frame.pixels.insert(frame.pixels.end(), raw.begin(), raw.end());
}

std::span<const std::byte> body(const StreamFrame& frame, std::uint32_t packet) {
  if (packet == 0 || packet >= trailer_id(frame)) return {};
  const std::size_t begin = (packet - 1) * room(frame);
  return std::span(frame.pixels).subspan(begin, std::min(room(frame), frame.pixels.size() - begin));
}

}  // namespace fvd::sim::gvsp
