#include "sim/evaluate/slice_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <system_error>

#include <opencv2/imgcodecs.hpp>

#include "core/base/error.hpp"
#include "sim/evaluate/evaluate.hpp"
#include "sim/world/sim_world.hpp"

namespace fvd::sim {

namespace {

namespace fs = std::filesystem;

constexpr double kBeyond_um = 50.0;
constexpr int kMostSlices = 10000;
constexpr double kFarthest_um = 1e6;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kBadInput, message); }

/// z of the slices asked for.
std::vector<double> slice_heights_um(const Surface& surface, const SliceFileOptions& options) {
  const double step = options.step_um;
  if (!std::isfinite(step) || std::abs(step) < 1e-6 || std::abs(step) > kFarthest_um) {
    refuse("a step of " + std::to_string(step) + " um gives no stack: it is 1e-6 to 1e6 um long, or as much downwards");
  }
  const auto [low, high] = std::minmax_element(surface.height_um.pixels().begin(), surface.height_um.pixels().end());
  const double from = step > 0 ? static_cast<double>(*low) - kBeyond_um : static_cast<double>(*high) + kBeyond_um;
  const double to = step > 0 ? static_cast<double>(*high) + kBeyond_um : static_cast<double>(*low) - kBeyond_um;
  const double start = options.start_um.value_or(std::floor(from / step) * step);
  if (!std::isfinite(start) || std::abs(start) > kFarthest_um) {
    refuse("a start at " + std::to_string(start) + " um is out of reach: at most 1e6 um up or down");
  }
  const double wanted = options.slices ? static_cast<double>(*options.slices) : std::ceil((to - start) / step) + 1.0;
  if (!(wanted >= 2.0 && wanted <= kMostSlices)) {
    refuse("a stack has 2 to " + std::to_string(kMostSlices) + " slices; start, step and number ask for " +
           std::to_string(static_cast<long long>(wanted)));
  }
  std::vector<double> z_um(static_cast<std::size_t>(wanted));
  for (std::size_t k = 0; k < z_um.size(); ++k) z_um[k] = start + step * static_cast<double>(k);
  return z_um;
}

/// An empty folder, so that no slice of another stack lies among these.
void make_empty(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::kStorageWrite, "cannot make the folder " + folder.string() + ": " + error.message());
  const bool empty = fs::is_empty(folder, error);
  if (error)
    throw Error(ErrorCode::kStorageWrite, "cannot read the folder " + folder.string() + ": " + error.message());
  if (!empty) refuse(folder.string() + " is not empty: name a new folder, so that no other slice gets among these");
}

void write_image(const fs::path& file, const cv::Mat& image) {
  bool written = false;
  try {
    written = cv::imwrite(file.string(), image, {cv::IMWRITE_TIFF_COMPRESSION, 1, cv::IMWRITE_PNG_COMPRESSION, 1});
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw Error(ErrorCode::kStorageWrite, "cannot write " + file.string());
}

}  // namespace

const std::vector<std::string>& slice_formats() {
  static const std::vector<std::string> kFormats{"png", "tiff", "pgm"};
  return kFormats;
}

std::vector<double> write_slices(const WorldParameters& world, const fs::path& folder,
                                 const SliceFileOptions& options) {
  if (std::ranges::find(slice_formats(), options.format) == slice_formats().end()) {
    refuse("slices are no '" + options.format + "': png, tiff or pgm");
  }
  const Surface surface = make_surface(world);
  std::vector<double> z_um = slice_heights_um(surface, options);
  make_empty(folder);
  const auto renderer = make_renderer(world, surface);
  cv::Mat slice(surface.height_um.height(), surface.height_um.width(), CV_8U);
  ExposureRequest request;
  request.width = slice.cols;
  request.height = slice.rows;
  std::ofstream heights(folder / "z.txt");
  heights << "# um\n" << std::setprecision(12);
  for (std::size_t k = 0; k < z_um.size(); ++k) {
    request.exposure_index = k;
    renderer->render(z_um[k], request, std::as_writable_bytes(std::span(slice.data, slice.total())));
    char name[32];
    std::snprintf(name, sizeof name, "slice_%04zu.%s", k, options.format.c_str());
    write_image(folder / name, slice);
    heights << z_um[k] << '\n';
  }
  heights.close();
  if (!heights) throw Error(ErrorCode::kStorageWrite, "cannot write " + (folder / "z.txt").string());
  std::error_code error;
  fs::create_directory(folder / "truth", error);
  if (error) throw Error(ErrorCode::kStorageWrite, "cannot make " + (folder / "truth").string());
  write_truth(world, folder / "truth");
  return z_um;
}

}  // namespace fvd::sim
