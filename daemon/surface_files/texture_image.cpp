#include "daemon/surface_files/texture_image.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "daemon/surface_files/file_bytes.hpp"
#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

/// A PNG of 16 bit does not tell how many of them count.
PixelFormat format_of(const Plane<std::uint16_t>& grey, const std::optional<int>& told) {
  const auto pixels = grey.pixels();
  const int highest = told.value_or(pixels.empty() ? 0 : *std::max_element(pixels.begin(), pixels.end()));
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kMono10, PixelFormat::kMono12}) {
    if (highest <= max_grey_level(format)) return format;
  }
  return PixelFormat::kMono16;
}

}  // namespace

TextureImage read_texture(const std::filesystem::path& folder, const Surface& surface, const Result& result) {
  const std::filesystem::path path = folder / "texture.png";
  TextureImage texture;
  if (!std::filesystem::exists(path)) return texture;
  ImageFile image;
  try {
    read_png(path, image);
  } catch (const ImageFileError& error) {
    refuse(path, "file", error.what());
  }
  if (image.width != surface.width() || image.height != surface.height()) return texture;
  if (image.channels == 3 && image.bytes_per_sample == 1) {
    texture.colour = Plane<std::uint8_t>(3 * image.width, image.height);
    std::memcpy(texture.colour.row(0), image.samples.data(), image.samples.size());
  } else if (image.channels == 1) {
    texture.grey = Plane<std::uint16_t>(image.width, image.height);
    std::size_t at = 0;
    for (std::uint16_t& level : texture.grey.pixels()) {
      std::memcpy(&level, image.samples.data() + at, static_cast<std::size_t>(image.bytes_per_sample));
      at += static_cast<std::size_t>(image.bytes_per_sample);
    }
  }
  texture.format = format_of(texture.grey, result.focus.texture_max_grey);
  return texture;
}

}  // namespace fvd
