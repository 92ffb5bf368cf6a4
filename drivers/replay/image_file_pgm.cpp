#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

/// The next number of the header; comments run from # to the end of the line.
int header_number(std::istream& stream) {
  std::string comment;
  while ((stream >> std::ws) && stream.peek() == '#') std::getline(stream, comment);
  int value = 0;
  if (!(stream >> value)) throw ImageFileError("the header of a PGM was expected");
  return value;
}

void read_binary(std::istream& stream, ImageFile& image) {
  stream.get();  // the one blank between header and pixels
  const auto bytes = static_cast<std::streamsize>(image.samples.size());
  if (!stream.read(reinterpret_cast<char*>(image.samples.data()), bytes)) {
    throw ImageFileError("it ends after " + std::to_string(stream.gcount()) + " of " + std::to_string(bytes) +
                         " bytes of pixels");
  }
  if (image.bytes_per_sample == 1) return;
  for (std::size_t i = 0; i < image.samples.size(); i += 2) std::swap(image.samples[i], image.samples[i + 1]);
}

void read_decimal(std::istream& stream, ImageFile& image) {
  const auto width = static_cast<std::size_t>(image.bytes_per_sample);
  for (std::size_t i = 0; i < image.samples.size(); i += width) {
    int level = 0;
    if (!(stream >> level) || level < 0 || level > image.max_level) {
      throw ImageFileError("pixel " + std::to_string(i / width) + " is missing or not a number from 0 to " +
                           std::to_string(image.max_level));
    }
    const auto sample = static_cast<std::uint16_t>(level);
    std::memcpy(&image.samples[i], &sample, width);
  }
}

}  // namespace

void read_pgm(const std::filesystem::path& file, ImageFile& image) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ImageFileError("it cannot be opened");
  std::string magic(2, '\0');
  stream.read(magic.data(), 2);
  if (magic != "P5" && magic != "P2") throw ImageFileError("it does not begin as a PGM");
  const int width = header_number(stream);
  const int height = header_number(stream);
  const int max_level = header_number(stream);
  if (max_level < 1 || max_level > std::numeric_limits<std::uint16_t>::max()) {
    throw ImageFileError("a largest level of " + std::to_string(max_level) + " is not one of a PGM");
  }
  image.resize(width, height, 1, max_level > std::numeric_limits<std::uint8_t>::max() ? 2 : 1);
  image.max_level = max_level;
  if (magic == "P5") {
    read_binary(stream, image);
  } else {
    read_decimal(stream, image);
  }
}

}  // namespace fvd
