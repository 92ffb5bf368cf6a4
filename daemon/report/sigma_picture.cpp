/// Standard errors as a picture.

#include <algorithm>

#include "daemon/report/map_plot.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_page.hpp"
#include "daemon/report/surface_pictures.hpp"

namespace fvd {

std::string sigma_png(const PictureSurface& surface) {
  const bool known = surface.sigma_m.data != nullptr;
  const PicturePage page = picture_page(surface, known ? kBarRoom : 0.0);
  PictureFile file(page.width, page.height);
  Canvas& canvas = file.canvas();
  draw_page_title(canvas, page, surface, known ? "standard error of the heights" : "standard errors are not known");
  if (!known) return file.bytes();
  const ScalarImage image = shrunk_um(surface.sigma_m, kMostPicturePixels);
  const ValueRange range = robust_range(image, 0.005);
  draw_map(canvas, page.field, surface, coloured(image, range, ColourScale::kMagma));
  draw_colour_bar(canvas, page.field, range, ColourScale::kMagma, "standard error / µm");
  draw_hole_key(canvas, page);
  return file.bytes();
}

}  // namespace fvd
