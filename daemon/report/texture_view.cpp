/// The all-in-focus image with axes and scale bar.

#include <algorithm>
#include <cmath>

#include "daemon/report/map_plot.hpp"
#include "daemon/report/measurement_pictures.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_page.hpp"
#include "daemon/report/scalar_image.hpp"

namespace fvd {

namespace {

constexpr double kWhite = 255.0;

/// Red, green and blue, 0..255, of one pixel.
struct Pixel {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
};

Pixel pixel_at(const PictureTexture& texture, int x, int y) {
  if (texture.colour.data != nullptr) {
    const std::uint8_t* const bgr = texture.colour.row(y) + std::ptrdiff_t{3} * x;
    return {static_cast<double>(bgr[2]), static_cast<double>(bgr[1]), static_cast<double>(bgr[0])};
  }
  const double level = texture.grey.at(x, y) * kWhite / std::max(texture.max_grey, 1);
  return {level, level, level};
}

std::uint32_t packed(const Pixel& sum, double count) {
  const auto byte = [count](double value) {
    return static_cast<std::uint32_t>(std::clamp(std::lround(value / count), 0L, 255L));
  };
  return byte(sum.red) << 16U | byte(sum.green) << 8U | byte(sum.blue);
}

/// Means of blocks, so that no side is above the most that a picture shows.
Raster shrunk(const PictureTexture& texture, int width, int height) {
  const int factor = shrink_factor(width, height, kMostPicturePixels);
  Raster raster((width + factor - 1) / factor, (height + factor - 1) / factor, 0);
  for (int row = 0; row < raster.height; ++row) {
    for (int column = 0; column < raster.width; ++column) {
      Pixel sum;
      int count = 0;
      for (int y = row * factor; y < std::min(height, (row + 1) * factor); ++y) {
        for (int x = column * factor; x < std::min(width, (column + 1) * factor); ++x) {
          const Pixel pixel = pixel_at(texture, x, y);
          sum = {sum.red + pixel.red, sum.green + pixel.green, sum.blue + pixel.blue};
          ++count;
        }
      }
      raster.at(column, row) = packed(sum, count);
    }
  }
  return raster;
}

}  // namespace

std::string texture_view_png(const PictureSurface& surface, const PictureTexture& texture) {
  const PicturePage page = picture_page(surface, 0.0);
  PictureFile file(page.width, page.height);
  Canvas& canvas = file.canvas();
  const bool known = texture.grey.data != nullptr || texture.colour.data != nullptr;
  draw_page_title(canvas, page, surface, known ? "all-in-focus image" : "the image is not known");
  if (!known) return file.bytes();
  draw_map(canvas, page.field, surface, shrunk(texture, surface.height_m.width, surface.height_m.height));
  draw_scale_bar(canvas, page, surface, page.field.x);
  return file.bytes();
}

}  // namespace fvd
