#include "daemon/export/picture_exporters.hpp"

#include "daemon/export/export_input.hpp"
#include "daemon/report/measurement_pictures.hpp"
#include "daemon/report/report_pdf.hpp"
#include "daemon/report/surface_pictures.hpp"

namespace fvd {

namespace {

PictureSurface picture_of(const ExportInput& input) {
  PictureSurface surface;
  surface.height_m = input.map.height_m.view();
  if (!input.map.sigma_m.empty()) surface.sigma_m = input.map.sigma_m.view();
  if (!input.map.mask.empty()) surface.mask = input.map.mask.view();
  surface.pitch_x_um = input.data.pixel_pitch_x_um;
  surface.pitch_y_um = input.data.pixel_pitch_y_um;
  surface.title = result_title(input.data);
  surface.simulated = input.data.simulated;
  return surface;
}

}  // namespace

std::string preview_file(const ExportInput& input) { return overview_png(picture_of(input), input.result.get()); }

std::string sigma_picture_file(const ExportInput& input) { return sigma_png(picture_of(input)); }

std::string holes_picture_file(const ExportInput& input) { return holes_png(picture_of(input)); }

std::string view_picture_file(const ExportInput& input) { return view3d_png(picture_of(input)); }

std::string texture_view_file(const ExportInput& input) {
  PictureTexture texture;
  if (!input.map.texture.empty()) texture.grey = input.map.texture.view();
  if (!input.map.colour.empty()) texture.colour = input.map.colour.view();
  texture.max_grey = max_grey_level(input.map.texture_format);
  return texture_view_png(picture_of(input), texture);
}

std::string edge_picture_file(const ExportInput& input) {
  return edge_png(picture_of(input), input.result.get().evaluation.value());
}

std::string profile_picture_file(const ExportInput& input) {
  return profile_png(picture_of(input), input.measurement,
                     input.result.get().evaluation.value().measurements.at(input.measurement));
}

std::string report_file(const ExportInput& input) { return report_pdf(input.result.get(), picture_of(input)); }

}  // namespace fvd
