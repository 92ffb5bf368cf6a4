#include "daemon/export/surface_view.hpp"

#include "daemon/export/export_input.hpp"

namespace fvd {

std::vector<std::pair<std::string, std::string>> SurfaceOrigin::facts() const {
  std::vector<std::pair<std::string, std::string>> known;
  const auto add = [&known](const char* key, const std::string& value) {
    if (!value.empty()) known.emplace_back(key, value);
  };
  add("PartId", part_id);
  add("JobId", job_id);
  add("Recipe", recipe_id);
  add("RecipeSha256", recipe_sha256);
  add("Peak", peak);
  add("Software", software_version);
  add("Source", source);
  add("Simulated", simulated ? "true" : "false");
  return known;
}

SurfaceOrigin surface_origin(const ResultData& data) {
  return {result_title(data),    data.part_id,       data.job_id,
          data.recipe_id,        data.recipe_sha256, std::string(peak_method_name(data.peak)),
          data.software_version, data.source,        data.simulated,
          data.created};
}

SurfaceOrigin surface_origin(const Result& result) {
  const auto& [software_version, simulated, created, source] = result.provenance;
  ResultData names;
  names.part_id = result.job.part_id;
  names.job_id = result.job.id;
  return {result_title(names),
          result.job.part_id,
          result.job.id,
          result.recipe.id,
          result.recipe.sha256,
          std::string(peak_method_name(result.focus.peak)),
          software_version,
          source,
          simulated,
          created};
}

SurfaceView surface_view(const ExportInput& input) {
  SurfaceView view;
  view.height_m = input.map.height_m.view();
  if (!input.map.sigma_m.empty()) view.sigma_m = input.map.sigma_m.view();
  if (!input.map.texture.empty()) view.grey = input.map.texture.view();
  if (!input.map.colour.empty()) view.colour = input.map.colour.view();
  view.max_grey = max_grey_level(input.map.texture_format);
  view.pitch_x_um = input.data.pixel_pitch_x_um;
  view.pitch_y_um = input.data.pixel_pitch_y_um;
  view.origin = surface_origin(input.data);
  view.origin.peak = peak_method_name(input.peak);
  return view;
}

SurfaceView surface_view(const Surface& surface, SurfaceOrigin origin) {
  SurfaceView view;
  view.height_m = surface.height_m.view();
  if (surface.has_sigma()) view.sigma_m = surface.sigma_m.view();
  view.pitch_x_um = surface.pitch_x_um;
  view.pitch_y_um = surface.pitch_y_um;
  view.origin = std::move(origin);
  return view;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

}  // namespace fvd
