#include "daemon/surface_files/png_rows.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

class PngRows final : public MapRows {
 public:
  explicit PngRows(ImageFile&& image) : image_(std::move(image)) {}
  [[nodiscard]] GridSize size() const noexcept override { return {image_.width, image_.height}; }
  [[nodiscard]] std::size_t bytes() const noexcept override { return image_.samples.size(); }
  void read(int x, int y, int count, float* to) const override {
    const auto sample_bytes = static_cast<std::size_t>(image_.bytes_per_sample);
    const std::size_t pixel_bytes = sample_bytes * static_cast<std::size_t>(image_.channels);
    const std::byte* pixel = image_.samples.data() + image_.row_bytes() * static_cast<std::size_t>(y) +
                             pixel_bytes * static_cast<std::size_t>(x);
    for (int i = 0; i < count; ++i, pixel += pixel_bytes) {
      to[i] = image_.channels == 1 ? sample(pixel)
                                   : 0.114F * sample(pixel) + 0.587F * sample(pixel + sample_bytes) +
                                         0.299F * sample(pixel + 2 * sample_bytes);
    }
  }

 private:
  [[nodiscard]] float sample(const std::byte* at) const {
    std::uint16_t value = std::to_integer<std::uint16_t>(*at);
    if (image_.bytes_per_sample == 2) std::memcpy(&value, at, sizeof value);
    return static_cast<float>(value);
  }

  const ImageFile image_;
};

}  // namespace

GridSize png_size(const std::filesystem::path& path) {
  constexpr std::size_t kPlace = 16;  // of width and height, big-endian, behind signature and chunk head
  const std::string head = FileBytes(path).text(kPlace, 8);
  if (head.size() < 8) refuse(path, byte_place(kPlace), "the file ends");
  const auto side = [&head](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8U | static_cast<unsigned char>(head[i]);
    return static_cast<int>(std::min(value, 0x7FFFFFFFU));
  };
  return {side(0), side(4)};
}

std::shared_ptr<const MapRows> open_png_rows(const std::filesystem::path& path) {
  ImageFile image;
  try {
    read_png(path, image);
  } catch (const ImageFileError& error) {
    refuse(path, "file", error.what());
  }
  if ((image.channels != 1 && image.channels != 3) || image.bytes_per_sample > 2) {
    refuse(path, "file", "it is neither grey nor in colour, of 8 or 16 bit");
  }
  return std::make_shared<PngRows>(std::move(image));
}

}  // namespace fvd
