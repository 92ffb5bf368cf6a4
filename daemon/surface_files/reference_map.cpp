#include "daemon/surface_files/reference_map.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/units.hpp"
#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/surface_readers.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

double in_um(float metres) { return static_cast<double>(metres) / kMetresPerMicrometer; }

void add_sigma(const fs::path& path, metrology::HeightField& map) {
  const Surface sigma = read_gsf(path, {});
  if (sigma.width() != map.width() || sigma.height() != map.height()) {
    refuse(path, "size", "it is not that of the reference map");
  }
  map.sigma_um = Plane<float>::unset(map.width(), map.height());
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      float& error_um = map.sigma_um.at(column, row);
      error_um = static_cast<float>(in_um(sigma.height_m.at(column, row)));
      // A height of which the error is not known cannot be weighed, and a hole has none.
      if (!(error_um >= 0.0F)) map.z_um.at(column, row) = std::nan("");
      if (map.is_hole(column, row)) error_um = std::nanf("");
    }
  }
}

}  // namespace

std::string reference_sigma_name(const std::string& reference) {
  return fs::path(reference).stem().string() + "-sigma.gsf";
}

std::shared_ptr<const metrology::HeightField> read_reference_map(const fs::path& folder, const std::string& reference) {
  const fs::path path = folder / reference;
  if (reference.empty() || fs::path(reference).filename() != reference) {
    refuse(folder, "the name of the reference map", "\"" + reference + "\" is no name of a file in it");
  }
  const Surface heights = read_gsf(path, {});
  auto map = std::make_shared<metrology::HeightField>();
  map->pitch_x_um = heights.pitch_x_um;
  map->pitch_y_um = heights.pitch_y_um;
  map->z_um = Plane<double>::unset(heights.width(), heights.height());
  std::transform(heights.height_m.pixels().begin(), heights.height_m.pixels().end(), map->z_um.pixels().begin(), in_um);
  const fs::path sigma = folder / reference_sigma_name(reference);
  if (fs::exists(sigma)) add_sigma(sigma, *map);
  return map;
}

}  // namespace fvd
