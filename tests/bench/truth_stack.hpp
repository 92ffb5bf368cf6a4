#pragma once

/// Focus stacks with truth for bench_truth, made step by step: light, what disturbs it, the camera, files.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <random>
#include <vector>

#include <opencv2/core.hpp>

#include "core/image/image.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::bench {

/// A surface under a microscope. Planes of one size.
struct Scene {
  Plane<float> height_um;
  Plane<float> texture;  ///< 8-bit grey levels within 0..255
  double defocus_px_per_um = 0.07;
};

struct Camera {
  double read_noise = 1.5;     ///< standard deviation, 8-bit grey levels
  double shot_variance = 0.0;  ///< variance per grey level of light
  double black = 0.0;          ///< grey levels without light
};

/// Light of each slice, CV_32F in 8-bit grey levels, z = start_um + k step_um; noise comes later.
[[nodiscard]] std::vector<cv::Mat> light_of(const Scene& scene, double start_um, double step_um, int slices);

/// What the camera makes of light: CV_8U. Takes its noise from `random`.
[[nodiscard]] cv::Mat exposed(const cv::Mat& light, const Camera& camera, std::mt19937_64& random);
[[nodiscard]] std::vector<cv::Mat> exposed(const std::vector<cv::Mat>& light, const Camera& camera, std::uint64_t seed);

/// Heights of each column and row.
[[nodiscard]] Plane<float> surface_of(int width, int height, const std::function<double(int x, int y)>& height_um);
/// mean 128 + texture is brought to mean `grey`.
[[nodiscard]] Plane<float> texture_of(int width, int height, sim::TextureKind kind, double grey, double contrast,
                                      std::uint64_t seed);
/// The periodic image moved by (x, y) pixels, exactly.
[[nodiscard]] Plane<float> moved(const Plane<float>& image, double x_px, double y_px);

/// The slice while the part swings by +-amplitude along the angle (sine), or, with `twice`, exposed at both ends only.
[[nodiscard]] cv::Mat vibrated(const cv::Mat& light, double amplitude_px, double angle, bool twice);

/// Glints: Gaussian spots of sigma_px in focus, which blur with the surface's defocus at their place. light_sum: of all
/// their pixels, grey levels.
struct Glint {
  int x = 0;
  int y = 0;
};
void add_glints(cv::Mat& light, const Scene& scene, double z_um, const std::vector<Glint>& glints, double sigma_px,
                double light_sum);

/// Writes slice_000.pgm ... , z.txt and truth/truth.tiff (CV_32F, um) into a new folder. Throws std::runtime_error.
void write_stack(const std::filesystem::path& folder, const std::vector<cv::Mat>& slices, double start_um,
                 double step_um, const Plane<float>& truth_um);
/// truth/truth.tiff of an existing folder.
void write_truth_image(const std::filesystem::path& folder, const Plane<float>& truth_um);

}  // namespace fvd::bench
