/// The shaded view as a picture.

#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_page.hpp"
#include "daemon/report/surface_pictures.hpp"
#include "daemon/report/view_plot.hpp"

namespace fvd {

std::string view3d_png(const PictureSurface& surface) {
  PicturePage page;
  page.width = 600;
  page.height = 440;
  PictureFile file(page.width, page.height);
  draw_page_title(file.canvas(), page, surface, "surface from the front, coloured by height");
  draw_view(file.canvas(), {24.0, 56.0, 552.0, 372.0}, surface);
  return file.bytes();
}

}  // namespace fvd
