#include "drivers/replay/slice_image.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.hpp"
#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

/// " in slices", nothing for a file of the present folder.
std::string folder_text(const SliceLocation& location) {
  const std::string folder = location.file.parent_path().string();
  return folder.empty() ? "" : " in " + folder;
}

[[noreturn]] void refuse(const SliceLocation& location, const std::string& problem) {
  throw Error(ErrorCode::kBadInput, "slice " + location.name() + folder_text(location) + " " + problem);
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

void decode(const SliceLocation& location, ImageFile& image) {
  const std::string extension = lower_extension(location.file);
  if (extension == ".pgm") return read_pgm(location.file, image);
  if (extension == ".png") return read_png(location.file, image);
  if (extension == ".jpg" || extension == ".jpeg") return read_jpeg(location.file, image);
  if (extension != ".tif" && extension != ".tiff") refuse(location, "is none of PNG, TIFF, JPEG and PGM");
  if (!location.page && count_tiff_pages(location.file) > 1) {
    refuse(location, "has several pages; one slice a file was expected");
  }
  read_tiff(location.file, location.page.value_or(0), image);
}

PixelFormat format_of(const ImageFile& image) {
  if (image.bytes_per_sample == 1) return PixelFormat::kMono8;
  if (image.max_level == max_grey_level(PixelFormat::kMono10)) return PixelFormat::kMono10;
  if (image.max_level == max_grey_level(PixelFormat::kMono12)) return PixelFormat::kMono12;
  return PixelFormat::kMono16;
}

void split_colour(ImageFile& image, SliceImage& slice) {
  const bool wide = image.bytes_per_sample == 2;
  const cv::Mat colour(image.height, image.width, wide ? CV_16UC3 : CV_8UC3, image.samples.data());
  const auto points = colour.total();
  slice.pixels.resize(points * colour.elemSize1());
  cv::Mat grey(colour.size(), wide ? CV_16U : CV_8U, slice.pixels.data());
  cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
  slice.colour.resize(3 * points);
  cv::Mat shown(colour.size(), CV_8UC3, slice.colour.data());
  colour.convertTo(shown, CV_8U, wide ? 1.0 / 257.0 : 1.0);  // for people: 16 bit keep their upper 8
}

}  // namespace

void read_slice(const SliceLocation& location, SliceImage& slice) {
  ImageFile image;
  image.samples = std::move(slice.pixels);
  slice.colour.clear();
  try {
    decode(location, image);
  } catch (const ImageFileError& failure) {
    refuse(location, std::string("cannot be read: missing, damaged or not the image its name says (") + failure.what() +
                         "); record it again");
  }
  slice.format = format_of(image);
  slice.width = image.width;
  slice.height = image.height;
  if (image.channels == 3) {
    split_colour(image, slice);
  } else {
    slice.pixels = std::move(image.samples);
  }
}

}  // namespace fvd
