#include "sim/world/frame_watermark.hpp"

#include <array>
#include <cmath>

#include <zlib.h>

namespace fvd::sim {

namespace {

constexpr std::size_t kIndexBytes = 8;
constexpr std::size_t kValueBytes = 16;
constexpr std::size_t kMarkBytes = 20;

using Mark = std::array<std::uint8_t, kMarkBytes>;

std::uint32_t checksum(const Mark& mark, std::span<const std::byte> pixels) {
  const auto begin = ::crc32(0, mark.data(), kValueBytes);
  return static_cast<std::uint32_t>(
      ::crc32_z(begin, reinterpret_cast<const Bytef*>(pixels.data()), static_cast<z_size_t>(pixels.size())));
}

void put(Mark& mark, std::size_t at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) mark[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint64_t get(const Mark& mark, std::size_t at, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{mark[at + i]} << (8 * i);
  return value;
}

}  // namespace

void WatermarkedSource::render(const ExposureRequest& request, std::span<std::byte> out) {
  source_.render(request, out);
  const auto pixel = static_cast<std::size_t>(bytes_per_pixel(request.format));
  Mark mark{};
  put(mark, 0, request.exposure_index, kIndexBytes);
  const double z_um = z_um_(request.start + (request.end - request.start) / 2);
  put(mark, kIndexBytes, static_cast<std::uint64_t>(std::llround(z_um * 1000.0)), kIndexBytes);
  put(mark, kValueBytes, checksum(mark, out.subspan(kMarkBytes * pixel)), kMarkBytes - kValueBytes);
  for (std::size_t i = 0; i < kMarkBytes * pixel; ++i) out[i] = std::byte{0};
  for (std::size_t i = 0; i < kMarkBytes; ++i) out[i * pixel] = static_cast<std::byte>(mark[i]);
}

std::optional<Watermark> read_watermark(const ImageView& image) {
  const auto pixel = static_cast<std::size_t>(bytes_per_pixel(image.format));
  const auto row = static_cast<std::size_t>(image.width) * pixel;
  if (row < kMarkBytes * pixel || image.row_stride_bytes != static_cast<std::ptrdiff_t>(row)) return std::nullopt;
  const std::span all(image.data, row * static_cast<std::size_t>(image.height));
  Mark mark{};
  for (std::size_t i = 0; i < kMarkBytes; ++i) mark[i] = static_cast<std::uint8_t>(all[i * pixel]);
  if (checksum(mark, all.subspan(kMarkBytes * pixel)) != get(mark, kValueBytes, kMarkBytes - kValueBytes)) {
    return std::nullopt;
  }
  return Watermark{get(mark, 0, kIndexBytes),
                   static_cast<double>(static_cast<std::int64_t>(get(mark, kIndexBytes, kIndexBytes))) / 1000.0};
}

}  // namespace fvd::sim
