/// A cross section as a picture.

#include "daemon/report/measurement_pictures.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_page.hpp"
#include "daemon/report/profile_plot.hpp"
#include "daemon/report/section_title.hpp"

namespace fvd {

namespace {

constexpr double kMargin = 12.0;
constexpr double kTitle = 36.0;
constexpr int kWidth = 620;
constexpr int kHeight = 330;

}  // namespace

std::string profile_png(const PictureSurface& surface, const std::string& name,
                        const EvaluatedMeasurement& measurement) {
  PictureFile file(kWidth, kHeight);
  Canvas& canvas = file.canvas();
  PicturePage page;
  page.width = kWidth;
  page.height = kHeight;
  draw_page_title(canvas, page, surface, name + ": " + measurement_text(measurement));
  draw_profile(canvas, {kMargin, kMargin + kTitle, kWidth - 2.0 * kMargin, kHeight - 2.0 * kMargin - kTitle}, surface,
               *measurement.cross_section, section_title("cross section", *measurement.cross_section));
  return file.bytes();
}

}  // namespace fvd
