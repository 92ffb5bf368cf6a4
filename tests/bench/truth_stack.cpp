#include "tests/bench/truth_stack.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <span>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/world/defocus_renderer.hpp"
#include "sim/world/texture.hpp"

namespace fvd::bench {

namespace {

/// A view of the plane, for reading.
cv::Mat mat_of(const Plane<float>& plane) {
  return {plane.height(), plane.width(), CV_32F, const_cast<float*>(plane.row(0))};
}

void write_image(const std::filesystem::path& file, const cv::Mat& image) {
  if (!cv::imwrite(file.string(), image)) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

std::vector<cv::Mat> light_of(const Scene& scene, double start_um, double step_um, int slices) {
  sim::DefocusRenderer renderer(scene.texture, scene.height_um,
                                {.defocus_px_per_um = scene.defocus_px_per_um, .readout_noise = 0.0});
  sim::ExposureRequest request;
  request.format = PixelFormat::kMono16;
  request.width = scene.texture.width();
  request.height = scene.texture.height();
  cv::Mat fine(request.height, request.width, CV_16U);
  std::vector<cv::Mat> light;
  for (int k = 0; k < slices; ++k) {
    renderer.render(start_um + step_um * k, request, std::as_writable_bytes(std::span(fine.data, 2 * fine.total())));
    fine.convertTo(light.emplace_back(), CV_32F, 1.0 / 256);
  }
  return light;
}

cv::Mat exposed(const cv::Mat& light, const Camera& camera, std::mt19937_64& random) {
  std::normal_distribution<float> normal;
  const auto read = static_cast<float>(camera.read_noise * camera.read_noise);
  const auto shot = static_cast<float>(camera.shot_variance);
  const auto black = static_cast<float>(camera.black);
  cv::Mat image(light.size(), CV_8U);
  for (int y = 0; y < light.rows; ++y) {
    for (int x = 0; x < light.cols; ++x) {
      const float level = light.at<float>(y, x);
      const float seen = level + black + normal(random) * std::sqrt(read + shot * std::max(level, 0.0F));
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(seen);
    }
  }
  return image;
}

std::vector<cv::Mat> exposed(const std::vector<cv::Mat>& light, const Camera& camera, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<cv::Mat> images;
  images.reserve(light.size());
  for (const cv::Mat& slice : light) images.push_back(exposed(slice, camera, random));
  return images;
}

Plane<float> surface_of(int width, int height, const std::function<double(int x, int y)>& height_um) {
  Plane<float> surface(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) surface.at(x, y) = static_cast<float>(height_um(x, y));
  }
  return surface;
}

Plane<float> texture_of(int width, int height, sim::TextureKind kind, double grey, double contrast,
                        std::uint64_t seed) {
  const Plane<std::uint8_t> rich(width, height);
  Plane<float> texture = sim::make_texture(kind, rich, contrast, 1.0, seed);
  for (float& level : texture.pixels()) level = std::clamp(level + static_cast<float>(grey) - 128.0F, 0.0F, 255.0F);
  return texture;
}

Plane<float> moved(const Plane<float>& image, double x_px, double y_px) {
  cv::Mat spectrum;
  cv::dft(mat_of(image), spectrum, cv::DFT_COMPLEX_OUTPUT);
  const auto frequency = [](int k, int n) { return 2.0 * std::numbers::pi * (k <= n / 2 ? k : k - n) / n; };
  for (int y = 0; y < spectrum.rows; ++y) {
    for (int x = 0; x < spectrum.cols; ++x) {
      const double phase = -frequency(x, spectrum.cols) * x_px - frequency(y, spectrum.rows) * y_px;
      auto& value = spectrum.at<cv::Vec2f>(y, x);
      const auto cosine = static_cast<float>(std::cos(phase));
      const auto sine = static_cast<float>(std::sin(phase));
      value = {value[0] * cosine - value[1] * sine, value[0] * sine + value[1] * cosine};
    }
  }
  Plane<float> result(image.width(), image.height());
  cv::Mat out(image.height(), image.width(), CV_32F, result.row(0));
  cv::dft(spectrum, out, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return result;
}

cv::Mat vibrated(const cv::Mat& light, double amplitude_px, double angle, bool twice) {
  const int reach = static_cast<int>(std::ceil(amplitude_px)) + 1;
  cv::Mat path = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_32F);
  const int places = twice ? 2 : 64;
  for (int i = 0; i < places; ++i) {
    const double swing = twice ? 2.0 * i - 1.0 : std::sin(2.0 * std::numbers::pi * (i + 0.5) / places);
    const double x = reach + amplitude_px * swing * std::cos(angle);
    const double y = reach + amplitude_px * swing * std::sin(angle);
    const int left = static_cast<int>(x);
    const int top = static_cast<int>(y);
    for (int v = 0; v < 2; ++v) {
      for (int u = 0; u < 2; ++u) {
        const double weight = (1.0 - std::abs(x - (left + u))) * (1.0 - std::abs(y - (top + v)));
        path.at<float>(top + v, left + u) += static_cast<float>(weight / places);
      }
    }
  }
  cv::Mat result;
  cv::filter2D(light, result, CV_32F, path, {-1, -1}, 0, cv::BORDER_REFLECT);
  return result;
}

void add_glints(cv::Mat& light, const Scene& scene, double z_um, const std::vector<Glint>& glints, double sigma_px,
                double light_sum) {
  for (const Glint& glint : glints) {
    const double defocus_px =
        scene.defocus_px_per_um * (z_um - static_cast<double>(scene.height_um.at(glint.x, glint.y)));
    const double square = sigma_px * sigma_px + defocus_px * defocus_px;
    const double level = light_sum / (2.0 * std::numbers::pi * square);
    const int reach = static_cast<int>(std::ceil(5.0 * std::sqrt(square)));
    for (int y = std::max(glint.y - reach, 0); y <= std::min(glint.y + reach, light.rows - 1); ++y) {
      for (int x = std::max(glint.x - reach, 0); x <= std::min(glint.x + reach, light.cols - 1); ++x) {
        const double distance = std::pow(x - glint.x, 2) + std::pow(y - glint.y, 2);
        light.at<float>(y, x) += static_cast<float>(level * std::exp(-0.5 * distance / square));
      }
    }
  }
}

void write_truth_image(const std::filesystem::path& folder, const Plane<float>& truth_um) {
  std::filesystem::create_directories(folder / "truth");
  write_image(folder / "truth/truth.tiff", mat_of(truth_um));
}

void write_stack(const std::filesystem::path& folder, const std::vector<cv::Mat>& slices, double start_um,
                 double step_um, const Plane<float>& truth_um) {
  std::filesystem::create_directories(folder);
  std::ofstream heights(folder / "z.txt");
  for (std::size_t k = 0; k < slices.size(); ++k) {
    char name[32];
    std::snprintf(name, sizeof name, "slice_%03zu.pgm", k);
    write_image(folder / name, slices[k]);
    heights << start_um + step_um * static_cast<double>(k) << '\n';
  }
  heights.close();
  if (!heights) throw std::runtime_error("cannot write " + (folder / "z.txt").string());
  write_truth_image(folder, truth_um);
}

}  // namespace fvd::bench
