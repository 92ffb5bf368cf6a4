#include "sim/world/gsf_reader.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "core/base/error.hpp"

namespace fvd::sim {

namespace {

static_assert(std::endian::native == std::endian::little, "GSF data are little-endian");

constexpr int kMaxSide = 32768;

class GsfReader {
 public:
  explicit GsfReader(const std::filesystem::path& file) : file_(file) {}

  Plane<float> read() {
    std::ifstream in(file_, std::ios::binary);
    if (!in) fail("it cannot be opened");
    std::ostringstream text;
    text << in.rdbuf();
    content_ = text.str();
    read_header();
    const int width = side("XRes");
    const int height = side("YRes");
    if (const auto unit = header_.find("ZUnits"); unit != header_.end() && unit->second != "m") {
      fail("its heights are in '" + unit->second + "', not in m");
    }
    const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (content_.size() - data_begin_ != bytes) {
      fail("it holds " + std::to_string(content_.size() - data_begin_) + " bytes of data, " + std::to_string(width) +
           " x " + std::to_string(height) + " points need " + std::to_string(bytes));
    }
    Plane<float> heights(width, height);
    std::memcpy(heights.row(0), content_.data() + data_begin_, bytes);
    for (float& height_value : heights.pixels()) {
      if (!std::isfinite(height_value)) fail("it has holes; a surface needs a height everywhere");
      height_value *= 1e6F;
    }
    return heights;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(ErrorCode::kBadInput, "height map " + file_.string() + ": " + reason);
  }

  void read_header() {
    const std::size_t end = content_.find('\0');
    if (!content_.starts_with("Gwyddion Simple Field 1.0\n") || end == std::string::npos) {
      fail("it is not a Gwyddion Simple Field 1.0");
    }
    data_begin_ = end + 4 - end % 4;  // 1 to 4 NUL bytes up to a multiple of 4
    if (data_begin_ > content_.size()) fail("it ends within its header");
    std::istringstream lines(content_.substr(0, end));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      const std::size_t equals = line.find('=');
      if (equals == std::string::npos) fail("the header line '" + line + "' has no '='");
      header_[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
    }
  }

  static std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return "";
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
  }

  int side(const char* key) const {
    const auto found = header_.find(key);
    int value = 0;
    if (found != header_.end()) {
      std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
    }
    if (value < 1 || value > kMaxSide) fail(std::string(key) + " must stand in its header and lie within 1..32768");
    return value;
  }

  std::filesystem::path file_;
  std::string content_;
  std::map<std::string, std::string> header_;
  std::size_t data_begin_ = 0;
};

}  // namespace

Plane<float> read_gsf_um(const std::filesystem::path& file) { return GsfReader(file).read(); }

}  // namespace fvd::sim
