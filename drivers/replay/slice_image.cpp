#include "drivers/replay/slice_image.hpp"

#include <string>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.hpp"
#include "drivers/replay/name_fields.hpp"
#include "drivers/replay/tiff_pages.hpp"

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

void decode(const SliceLocation& location, ImageFile& image) {
  const std::string extension = plain_extension(location.file.filename().string());
  if (extension == ".pgm") return read_pgm(location.file, image);
  if (extension == ".png") return read_png(location.file, image);
  if (extension == ".jpg") return read_jpeg(location.file, image);
  if (extension == ".bmp") return read_bmp(location.file, image);
  if (extension != ".tif") refuse(location, "is none of PNG, TIFF, JPEG, PGM and BMP");
  if (location.contiguous) return read_contiguous_tiff(location.file, *location.page, image);
  if (location.page) return read_tiff(location.file, *location.page, image);
  const std::vector<int> pages = tiff_content(location.file).images;
  if (pages.size() > 1) refuse(location, "has several pages; one slice a file was expected");
  read_tiff(location.file, pages.empty() ? 0 : pages.front(), image);
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
  colour.convertTo(shown, CV_8U, wide ? 255.0 / max_grey_level(slice.format) : 1.0);  // for people: the upper 8 bits
}

}  // namespace

namespace {

/// Runs action on the file's image; its ImageFileError becomes an Error that names the slice.
template <typename Action>
void on_image(const SliceLocation& location, const Action& action) {
  try {
    action();
  } catch (const ImageFileError& failure) {
    refuse(location, std::string("cannot be read: missing, damaged or not the image its name says (") + failure.what() +
                         "); record it again");
  }
}

/// As many slices tell how the levels of most stacks are used.
constexpr std::size_t kSurveyed = 5;

}  // namespace

void decode_slice(const SliceLocation& location, ImageFile& image) {
  on_image(location, [&] { decode(location, image); });
}

void read_slice(const SliceLocation& location, const GreyMapping& mapping, SliceImage& slice) {
  ImageFile image;
  image.samples = std::move(slice.pixels);
  slice.colour.clear();
  decode_slice(location, image);
  try {
    apply(mapping, image);
  } catch (const ImageFileError& failure) {
    refuse(location, std::string("does not fit the others: ") + failure.what());
  }
  slice.format = mapping.format;
  slice.width = image.width;
  slice.height = image.height;
  if (image.channels == 3) {
    split_colour(image, slice);
  } else {
    slice.pixels = std::move(image.samples);
  }
}

void read_slice(const SliceLocation& location, SliceImage& slice) {
  read_slice(location, survey_slices({location}, 0), slice);
}

GreyMapping survey_slices(const std::vector<SliceLocation>& slices, int significant_bits) {
  if (slices.empty()) throw Error(ErrorCode::kBadInput, "a recorded stack without slices");
  GreySurvey survey(significant_bits);
  ImageFile image;
  std::vector<bool> seen(slices.size());
  const auto look = [&](std::size_t index) {
    if (seen[index]) return;
    seen[index] = true;
    decode_slice(slices[index], image);
    on_image(slices[index], [&] { survey.add(image); });
  };
  const std::size_t last = slices.size() - 1;
  for (std::size_t i = 0; i < kSurveyed && !survey.decided(); ++i) look(i * last / (kSurveyed - 1));
  for (std::size_t i = 0; i <= last && survey.wants_all(); ++i) look(i);
  GreyMapping mapping;
  try {
    mapping = survey.mapping();
  } catch (const ImageFileError& failure) {  // only of bits that were told
    refuse(slices.front(),
           "does not fit --significant-bits " + std::to_string(significant_bits) + ": " + failure.what());
  }
  return mapping;
}

}  // namespace fvd
