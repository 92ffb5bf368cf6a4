#include <algorithm>
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

/// Before memory is asked for: a damaged header may tell of pixels that are not there. decimal: in numbers, which take
/// a byte at least.
void check_length(std::istream& stream, std::int64_t pixels, int bytes_per_sample, bool decimal) {
  stream.clear();  // a file may end with its header
  const auto begin = stream.tellg();
  stream.seekg(0, std::ios::end);
  const std::int64_t there = std::max<std::int64_t>(stream.tellg() - begin - 1, 0);  // behind the one blank
  stream.seekg(begin);
  const std::int64_t wanted = decimal ? pixels : pixels * bytes_per_sample;
  if (there < wanted) {
    throw ImageFileError("it ends after " + std::to_string(there) + " of " + std::to_string(wanted) +
                         " bytes of pixels");
  }
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
  const int bytes_per_sample = max_level > std::numeric_limits<std::uint8_t>::max() ? 2 : 1;
  ImageFile::check_size(width, height);
  check_length(stream, std::int64_t{width} * height, bytes_per_sample, magic == "P2");
  image.resize(width, height, 1, bytes_per_sample);
  image.max_level = max_level;
  if (magic == "P5") {
    read_binary(stream, image);
  } else {
    read_decimal(stream, image);
  }
}

}  // namespace fvd
