#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

/// The bytes of a file, little-endian.
class Bytes {
 public:
  explicit Bytes(std::istream& stream)
      : bytes_((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>()) {}

  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size) const {
    if (at + size > bytes_.size()) throw ImageFileError("it ends before its header does");
    std::uint32_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8U | static_cast<std::uint8_t>(bytes_[at + i]);
    return value;
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::uint8_t at(std::size_t index) const { return static_cast<std::uint8_t>(bytes_[index]); }

 private:
  std::vector<char> bytes_;
};

/// BITMAPINFOHEADER and its successors; offsets in the file.
struct Header {
  std::size_t pixels = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;  ///< negative: the first row is the top one
  std::uint32_t bits = 0;
  std::size_t palette = 0;
  std::uint32_t colours = 0;  ///< of the palette
};

using Colour = std::array<std::uint8_t, 3>;  // blue, green, red

Header read_header(const Bytes& file) {
  if (file.size() < 2 || file.at(0) != 'B' || file.at(1) != 'M') throw ImageFileError("it does not begin as a BMP");
  Header header;
  header.pixels = file.number(10, 4);
  const std::uint32_t header_bytes = file.number(14, 4);
  if (header_bytes < 40) throw ImageFileError("its header is of OS/2 1.x");
  header.width = static_cast<std::int32_t>(file.number(18, 4));
  header.height = static_cast<std::int32_t>(file.number(22, 4));
  header.bits = file.number(28, 2);
  const std::uint32_t compression = file.number(30, 4);
  constexpr std::uint32_t kBitFields = 3;
  const bool usual_fields = compression == kBitFields && header.bits == 32 && file.number(54, 4) == 0x00FF0000U &&
                            file.number(58, 4) == 0x0000FF00U && file.number(62, 4) == 0x000000FFU;
  const bool known = header.bits == 1 || header.bits == 4 || header.bits == 8 || header.bits == 24 || header.bits == 32;
  if (!known || (compression != 0 && !usual_fields)) {
    throw ImageFileError("a BMP of " + std::to_string(header.bits) + " bits, compression " +
                         std::to_string(compression) + "; read are uncompressed ones of 1, 4, 8, 24 and 32 bits");
  }
  header.palette = 14 + std::size_t{header_bytes};
  if (header.bits <= 8) {
    header.colours = file.number(46, 4);
    if (header.colours == 0 || header.colours > (1U << header.bits)) header.colours = 1U << header.bits;
  }
  return header;
}

std::vector<Colour> read_palette(const Bytes& file, const Header& header, bool& grey) {
  std::vector<Colour> palette;
  grey = true;
  for (std::uint32_t i = 0; i < header.colours; ++i) {
    const std::uint32_t colour = file.number(header.palette + std::size_t{4} * i, 4);
    const Colour entry{static_cast<std::uint8_t>(colour), static_cast<std::uint8_t>(colour >> 8U),
                       static_cast<std::uint8_t>(colour >> 16U)};
    grey = grey && entry[0] == entry[1] && entry[1] == entry[2];
    palette.push_back(entry);
  }
  return palette;
}

}  // namespace

void read_bmp(const std::filesystem::path& path, ImageFile& image) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw ImageFileError("it cannot be opened");
  const Bytes file(stream);
  const Header header = read_header(file);
  bool grey = false;
  const std::vector<Colour> palette = read_palette(file, header, grey);
  const std::int64_t height = std::abs(header.height);
  ImageFile::check_size(header.width, height);
  const std::size_t row_bytes = (static_cast<std::size_t>(header.width) * header.bits + 31) / 32 * 4;
  if (header.pixels + row_bytes * static_cast<std::size_t>(height) > file.size()) {
    throw ImageFileError("it ends before its last row of pixels");
  }
  image.resize(header.width, height, header.bits <= 8 && grey ? 1 : 3, 1);
  for (int y = 0; y < image.height; ++y) {
    const int stored = header.height < 0 ? y : image.height - 1 - y;
    const std::size_t row = header.pixels + row_bytes * static_cast<std::size_t>(stored);
    std::byte* out = image.row(y);
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width); ++x) {
      Colour colour{};
      if (header.bits <= 8) {
        const std::size_t bit = x * header.bits;
        const unsigned byte = file.at(row + bit / 8);
        const unsigned index = byte >> (8 - header.bits - bit % 8) & ((1U << header.bits) - 1U);
        if (index >= palette.size()) throw ImageFileError("a pixel has no colour in its palette");
        colour = palette[index];
      } else {
        for (std::size_t c = 0; c < 3; ++c) colour[c] = file.at(row + x * header.bits / 8 + c);
      }
      for (int c = 0; c < image.channels; ++c) *out++ = static_cast<std::byte>(colour[static_cast<std::size_t>(c)]);
    }
  }
}

}  // namespace fvd
