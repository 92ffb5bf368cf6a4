#include "drivers/replay/image_file.hpp"

#include <string>

namespace fvd {

void ImageFile::check_size(std::int64_t width, std::int64_t height) {
  constexpr std::int64_t kMaxSide = 65'535;
  constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;  // a damaged header must not ask for all memory
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide || width * height > kMaxPixels) {
    throw ImageFileError("an image of " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels is not a slice");
  }
}

void ImageFile::resize(std::int64_t new_width, std::int64_t new_height, int new_channels, int new_bytes_per_sample) {
  check_size(new_width, new_height);
  width = static_cast<int>(new_width);
  height = static_cast<int>(new_height);
  channels = new_channels;
  bytes_per_sample = new_bytes_per_sample;
  max_level = 0;
  samples.resize(row_bytes() * static_cast<std::size_t>(height));
}

}  // namespace fvd
