#pragma once

/// The GigE Vision stream protocol as bytes: an image as leader, payload and trailer packets (GigE Vision 1.2; block
/// ids of 64 bit as in 2.0). All numbers on the wire are big-endian.

#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace fvd::sim {

/// How image and chunks of data about it travel together; the values are those of the camera's register.
enum class ChunkMode : std::uint8_t {
  kOff = 0,
  kExtended = 1,  ///< an image that says that chunks follow it
  kPlain = 2,     ///< chunks of GigE Vision 1.x: the leader has the time, but no geometry
};

/// One image ready to be sent.
struct StreamFrame {
  std::uint64_t block_id = 0;  ///< 1..65535, or 64 bit if extended
  bool extended_ids = false;
  std::uint64_t timestamp_ns = 0;
  std::uint32_t pfnc = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t offset_x = 0;
  std::uint32_t offset_y = 0;
  std::vector<std::byte> pixels;  ///< as they go over the wire; in chunk mode the chunks too
  ChunkMode chunks = ChunkMode::kOff;
  std::uint32_t x_padding = 0;   ///< bytes after every line
  std::set<std::uint32_t> gone;  ///< packets that leave neither now nor when asked for

  std::uint32_t to_address = 0;  ///< IPv4, host order; with port 0 nobody listens
  int to_port = 0;
  int packet_size = 1500;      ///< IP, UDP and GVSP headers included
  std::uint32_t delay_ns = 0;  ///< between packets
};

namespace gvsp {

/// Bytes of IP, UDP and GVSP headers.
[[nodiscard]] int header_bytes(bool extended_ids);
/// The number of the last packet, the trailer; the leader is 0.
[[nodiscard]] std::uint32_t trailer_id(const StreamFrame& frame);
/// GVSP header and, of leader and trailer, what follows it. Packets beyond the trailer's number do not exist.
[[nodiscard]] std::vector<std::uint8_t> head(const StreamFrame& frame, std::uint32_t packet);
/// The pixels that follow the header; empty for leader and trailer.
[[nodiscard]] std::span<const std::byte> body(const StreamFrame& frame, std::uint32_t packet);

/// A packet that says that the one asked for cannot be had any more.
[[nodiscard]] std::vector<std::uint8_t> unavailable(std::uint64_t block_id, bool extended_ids, std::uint32_t packet);
/// Bytes that append_chunks() adds.
[[nodiscard]] std::size_t chunk_bytes();
/// Makes the frame's image a chunk, and adds those of its number, its time and its exposure.
void append_chunks(StreamFrame& frame, double exposure_us);

}  // namespace gvsp

}  // namespace fvd::sim
