#include "daemon/ctl/kept_slices.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "daemon/base/version.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "drivers/replay/slice_image.hpp"
#include "drivers/replay/z_list.hpp"

namespace fvd::ctl {

namespace {

namespace fs = std::filesystem;

constexpr const char* kHeights = "z.txt";

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kBadInput, message); }

/// Heights are in result.json to 0.1 nm.
std::optional<double> commanded_step_um(const Result::Slices& slices) {
  if (!slices.first_um || !slices.last_um || slices.planned < 2) return std::nullopt;
  constexpr double kPerMicrometre = 1e4;
  const double step_um = (*slices.last_um - *slices.first_um) / (slices.planned - 1);
  return std::round(step_um * kPerMicrometre) / kPerMicrometre;
}

std::optional<double> known_pitch(const fs::path& json, const char* place, const std::optional<double>& told,
                                  const std::optional<double>& given) {
  if (!told && !given) return std::nullopt;
  return pitch_of(json, place, told, given);
}

std::string description_of(const Result& result) {
  std::string text = result.job.id.empty() ? std::string("slices") : "slices of job " + result.job.id;
  if (!result.recipe.id.empty()) text += ", recipe " + result.recipe.id;
  if (!result.objective.empty()) text += ", objective " + result.objective;
  if (!result.provenance.source.empty()) text += ", " + result.provenance.source;
  return text + (result.provenance.simulated ? ", SIMULATED" : "");
}

/// The narrowest that has room for the levels; nothing for a file that no job wrote.
std::optional<PixelFormat> format_of(const ImageFile& image) {
  if (image.channels != 1) return std::nullopt;
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kMono10, PixelFormat::kMono12, PixelFormat::kMono16}) {
    if (image.max_level <= max_grey_level(format) && image.bytes_per_sample == bytes_per_pixel(format)) return format;
  }
  return std::nullopt;
}

}  // namespace

KeptSlices::KeptSlices(const fs::path& job, const SurfaceReadOptions& options) : folder_(job / "slices") {
  if (!fs::is_directory(job)) refuse(job.string() + " is no folder of a result: ome-tiff is made of a job's slices");
  if (!fs::is_directory(folder_)) {
    refuse(job.string() +
           " has no recorded slices: a job keeps them where its recipe has \"keep\": {\"slices\": true}; set it, "
           "measure again, and export that result");
  }
  const Result result = read_result(job);
  const fs::path json = job / "result.json";
  stack_.name = result.job.part_id.empty() ? result.job.id : result.job.part_id;
  if (stack_.name.empty()) stack_.name = fs::absolute(job).lexically_normal().stem().string();
  stack_.description = description_of(result);
  stack_.software = std::string("fvd ") + kVersion;
  stack_.acquired = result.provenance.created;
  stack_.pitch_x_um = known_pitch(json, "/focus/pixel_pitch_x_um", result.focus.pixel_pitch_x_um, options.pitch_x_um);
  stack_.pitch_y_um = known_pitch(json, "/focus/pixel_pitch_y_um", result.focus.pixel_pitch_y_um, options.pitch_y_um);
  stack_.step_um = commanded_step_um(result.slices);
  stack_.exposure_us = result.slices.exposure_us;
  stack_.z_um = read_z_list(folder_ / kHeights, "um");
  const int slices = stack_.slices();
  if (slices == 0) refuse((folder_ / kHeights).string() + " tells no height");
  if (fs::exists(folder_ / recorded_slice_name(slices))) {
    refuse((folder_ / kHeights).string() + " tells " + std::to_string(slices) + " heights, but there is a " +
           recorded_slice_name(slices) + ": slices and heights are not of the same job");
  }
  decode(0);
  const auto format = format_of(image_);
  if (!format) refuse((folder_ / recorded_slice_name(0)).string() + " is not grey of 8 to 16 bit, as jobs keep slices");
  stack_.format = *format;
  stack_.width = image_.width;
  stack_.height = image_.height;
}

void KeptSlices::decode(int index) {
  decode_slice({folder_ / recorded_slice_name(index), std::nullopt, false}, image_);
}

ImageView KeptSlices::read(int index) {
  decode(index);
  if (image_.width != stack_.width || image_.height != stack_.height || format_of(image_) != stack_.format) {
    refuse((folder_ / recorded_slice_name(index)).string() + " has " + std::to_string(image_.width) + " x " +
           std::to_string(image_.height) + " pixels up to level " + std::to_string(image_.max_level) +
           ", the first slice " + std::to_string(stack_.width) + " x " + std::to_string(stack_.height) + " up to " +
           std::to_string(max_grey_level(stack_.format)) + ": all must be equal");
  }
  return {stack_.format, image_.width, image_.height, static_cast<std::ptrdiff_t>(image_.row_bytes()),
          image_.samples.data()};
}

}  // namespace fvd::ctl
