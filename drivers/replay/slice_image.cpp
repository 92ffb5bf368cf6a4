#include "drivers/replay/slice_image.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"

namespace fvd {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const SliceLocation& location, const std::string& problem) {
  throw Error(ErrorCode::kBadInput,
              "slice " + location.name() + " in " + location.file.parent_path().string() + " " + problem);
}

bool has_extension(const fs::path& file, std::initializer_list<const char*> extensions) {
  std::string own = file.extension().string();
  for (char& c : own) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::any_of(extensions.begin(), extensions.end(), [&](const char* other) { return own == other; });
}

/// libjpeg fills what is missing of a truncated file with grey; a whole one has an end marker after its last scan.
bool jpeg_is_whole(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const auto scan = bytes.rfind("\xFF\xDA");
  return scan != std::string::npos && bytes.find("\xFF\xD9", scan) != std::string::npos;
}

/// Largest grey level that a binary PGM declares; 0 if it is none.
int pgm_max_level(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string word;
  if (!(stream >> word) || word != "P5") return 0;
  int value = 0;
  for (int field = 0; field < 3; ++field) {
    while ((stream >> std::ws) && stream.peek() == '#') std::getline(stream, word);
    if (!(stream >> value)) return 0;
  }
  return value;
}

PixelFormat format_of(const cv::Mat& image, const SliceLocation& location) {
  if (image.depth() == CV_8U) return PixelFormat::kMono8;
  if (!has_extension(location.file, {".pgm"})) return PixelFormat::kMono16;
  const int level = pgm_max_level(location.file);
  if (level == max_grey_level(PixelFormat::kMono10)) return PixelFormat::kMono10;
  if (level == max_grey_level(PixelFormat::kMono12)) return PixelFormat::kMono12;
  return PixelFormat::kMono16;
}

cv::Mat decode(const SliceLocation& location) {
  try {
    if (location.page) {
      std::vector<cv::Mat> images;
      cv::imreadmulti(location.file.string(), images, *location.page, 1, cv::IMREAD_UNCHANGED);
      return images.size() == 1 ? images.front() : cv::Mat();
    }
    return cv::imread(location.file.string(), cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return {};  // reported by the caller, with the file's name
  }
}

/// For people: 16 bit keep their upper 8.
std::vector<std::uint8_t> colour_of(const cv::Mat& image) {
  cv::Mat narrow;
  image.convertTo(narrow, CV_8U, image.depth() == CV_16U ? 1.0 / 257.0 : 1.0);
  cv::Mat colour(narrow.rows, narrow.cols, CV_8UC3);
  if (narrow.channels() == 4) {
    cv::cvtColor(narrow, colour, cv::COLOR_BGRA2BGR);
  } else {
    narrow.copyTo(colour);
  }
  return {colour.data, colour.data + colour.total() * colour.elemSize()};
}

cv::Mat luminance(const cv::Mat& image, const SliceLocation& location) {
  cv::Mat grey;
  switch (image.channels()) {
    case 1:
      return image;
    case 3:
      cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
      return grey;
    case 4:
      cv::cvtColor(image, grey, cv::COLOR_BGRA2GRAY);
      return grey;
    default:
      refuse(location, "has " + std::to_string(image.channels()) + " channels; only grey and colour can be used");
  }
}

}  // namespace

SliceImage read_slice(const SliceLocation& location) {
  const bool tiff = has_extension(location.file, {".tif", ".tiff"});
  if (tiff && !location.page && count_pages(location.file) > 1) {
    refuse(location, "has several pages; one slice a file was expected");
  }
  const cv::Mat image = decode(location);
  if (image.empty() || (has_extension(location.file, {".jpg", ".jpeg"}) && !jpeg_is_whole(location.file))) {
    refuse(location, "cannot be read: missing, damaged or not the image its name says; record it again");
  }
  if (image.depth() != CV_8U && image.depth() != CV_16U) {
    refuse(location, "has pixels that are not 8 or 16 bit unsigned integers");
  }
  const cv::Mat grey = luminance(image, location);
  SliceImage slice{format_of(grey, location), grey.cols, grey.rows, {}, {}};
  const std::size_t row_bytes = grey.elemSize() * static_cast<std::size_t>(grey.cols);
  slice.pixels.resize(row_bytes * static_cast<std::size_t>(grey.rows));
  for (int y = 0; y < grey.rows; ++y) {
    std::memcpy(slice.pixels.data() + row_bytes * static_cast<std::size_t>(y), grey.ptr(y), row_bytes);
  }
  if (image.channels() > 1) slice.colour = colour_of(image);
  return slice;
}

int count_pages(const fs::path& tiff) {
  try {
    return static_cast<int>(cv::imcount(tiff.string(), cv::IMREAD_UNCHANGED));
  } catch (const cv::Exception&) {
    return 0;
  }
}

}  // namespace fvd
