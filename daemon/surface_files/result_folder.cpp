#include "daemon/surface_files/result_folder.hpp"

#include <algorithm>
#include <cstring>

#include "core/base/error.hpp"
#include "core/focus/lateral_period.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/png_rows.hpp"
#include "daemon/surface_files/surface_readers.hpp"
#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxResult_bytes = std::size_t{8} << 20U;

struct Candidate {
  const char* name;
  Surface (*read)(const fs::path&, const SurfaceReadOptions&);
};

constexpr Candidate kHeights[] = {
    {"height.tiff", read_float_tiff}, {"height.gsf", read_gsf}, {"height.sdf", read_sdf}, {"height.x3p", read_x3p}};
constexpr Candidate kSigmas[] = {{"sigma.tiff", read_float_tiff}, {"sigma.gsf", read_gsf}};

template <std::size_t size>
fs::path first_path(const fs::path& folder, const Candidate (&candidates)[size]) {
  for (const Candidate& candidate : candidates) {
    if (is_plain_file(folder / candidate.name)) return folder / candidate.name;
  }
  return {};
}

/// The first of the files that is there; nothing where none is.
template <std::size_t size>
std::optional<Surface> first_of(const fs::path& folder, const Candidate (&candidates)[size],
                                const SurfaceReadOptions& options) {
  for (const Candidate& candidate : candidates) {
    if (fs::exists(folder / candidate.name)) return candidate.read(folder / candidate.name, options);
  }
  return std::nullopt;
}

void check_shape(const fs::path& path, int width, int height, const Surface& surface) {
  if (width == surface.width() && height == surface.height()) return;
  refuse(path, "size",
         std::to_string(width) + " x " + std::to_string(height) + " points, the heights have " +
             std::to_string(surface.width()) + " x " + std::to_string(surface.height()));
}

Plane<MaskReasons> mask_of(const fs::path& path, const Surface& surface) {
  const GridSize told = png_size(path);  // looked at first: the decoder takes memory for it
  check_shape(path, told.width, told.height, surface);
  ImageFile image;
  try {
    read_png(path, image);
  } catch (const ImageFileError& error) {
    refuse(path, "file", error.what());
  }
  check_shape(path, image.width, image.height, surface);
  if (image.channels != 1 || image.bytes_per_sample != sizeof(MaskReasons))
    refuse(path, "file", "it is not grey of 16 bit");
  Plane<MaskReasons> mask = Plane<MaskReasons>::unset(image.width, image.height);
  std::memcpy(mask.row(0), image.samples.data(), image.samples.size());
  return mask;
}

}  // namespace

bool is_plain_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(fs::symlink_status(path, error));
}

fs::path heights_file(const fs::path& folder) { return first_path(folder, kHeights); }
fs::path sigma_file(const fs::path& folder) { return first_path(folder, kSigmas); }

Result read_result(const fs::path& folder) {
  const fs::path path = folder / "result.json";
  const FileBytes file(path);
  if (file.size() > kMaxResult_bytes) refuse(path, "file", "it is above 8 MiB");
  try {
    return read_result_json(file.text(0, kMaxResult_bytes));
  } catch (const Error& error) {
    refuse(path, "content", error.what());
  }
}

ResultSurface read_result_surface(const fs::path& folder, const SurfaceReadOptions& options) {
  // Not in braces: g++ 12 frees a member twice if the next one's initialiser throws.
  ResultSurface read;
  read.result = read_result(folder);
  const Result::Focus& focus = read.result.focus;
  const fs::path json = folder / "result.json";
  SurfaceReadOptions pitch;
  pitch.pitch_x_um = pitch_of(json, "/focus/pixel_pitch_x_um", focus.pixel_pitch_x_um, options.pitch_x_um);
  pitch.pitch_y_um = pitch_of(json, "/focus/pixel_pitch_y_um", focus.pixel_pitch_y_um, options.pitch_y_um);
  auto heights = first_of(folder, kHeights, pitch);
  if (!heights) refuse(folder, "folder", "it has no height.tiff, height.gsf, height.sdf or height.x3p");
  Surface& surface = read.surface = std::move(*heights);
  check_shape(json, focus.width_px, focus.height_px, surface);
  surface.pitch_x_um = *pitch.pitch_x_um;  // with every digit
  surface.pitch_y_um = *pitch.pitch_y_um;
  if (auto sigma = first_of(folder, kSigmas, pitch)) {
    check_shape(folder / "sigma", sigma->width(), sigma->height(), surface);
    surface.sigma_m = std::move(sigma->height_m);
  }
  if (fs::exists(folder / "mask.png")) surface.mask = mask_of(folder / "mask.png", surface);
  surface.lateral_period_um = lateral_period_px(focus.settings, {}) * std::max(surface.pitch_x_um, surface.pitch_y_um);
  surface.title = read.result.job.part_id.empty() ? folder.stem().string() : read.result.job.part_id;
  return read;
}

}  // namespace fvd
