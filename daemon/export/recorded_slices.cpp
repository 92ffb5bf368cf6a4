#include "daemon/export/recorded_slices.hpp"

#include <charconv>
#include <fstream>
#include <string_view>

namespace fvd {

std::string encode_pgm(const ImageView& slice) {
  std::string file = "P5\n" + std::to_string(slice.width) + " " + std::to_string(slice.height) + "\n" +
                     std::to_string(max_grey_level(slice.format)) + "\n";
  const auto width = static_cast<std::size_t>(slice.width);
  file.reserve(file.size() + width * static_cast<std::size_t>(slice.height * bytes_per_pixel(slice.format)));
  for (int y = 0; y < slice.height; ++y) {
    if (slice.format == PixelFormat::kMono8) {
      file.append(reinterpret_cast<const char*>(slice.as<std::uint8_t>().row(y)), width);
      continue;
    }
    const std::uint16_t* row = slice.as<std::uint16_t>().row(y);
    for (std::size_t x = 0; x < width; ++x) {  // PGM is big-endian
      file += static_cast<char>(row[x] >> 8U);
      file += static_cast<char>(row[x] & 0xFFU);
    }
  }
  return file;
}

std::string recorded_slice_name(int index) {
  std::string number = std::to_string(index);
  number.insert(0, number.size() < 5 ? 5 - number.size() : 0, '0');
  return "slice_" + number + ".pgm";
}

void SliceRecorder::add(const ImageView& slice, double z_um) {
  directory_.add_file("slices/" + recorded_slice_name(slices_), encode_pgm(slice));
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), z_um).ptr;  // shortest text that reads back equal
  z_lines_.append(text, end);
  z_lines_ += '\n';
  ++slices_;
}

namespace {

constexpr const char* kHeights = "z.txt";
constexpr std::string_view kSimulated = ", simulated";

}  // namespace

bool recorded_of_simulation(const std::filesystem::path& folder) {
  std::ifstream in(folder / kHeights);
  std::string head;
  return std::getline(in, head) && head.starts_with("# ") && head.ends_with(kSimulated);
}

void SliceRecorder::finish(const std::string& source, bool simulated) {
  std::string head = "# " + source + std::string(simulated ? kSimulated : "");
  for (char& c : head) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  directory_.add_file(std::string("slices/") + kHeights, head + "\n# measured z in um, one line a slice\n" + z_lines_);
}

}  // namespace fvd
