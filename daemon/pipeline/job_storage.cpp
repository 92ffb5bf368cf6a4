#include "daemon/pipeline/job_storage.hpp"

#include <array>
#include <string_view>

#include "daemon/export/exporter_table.hpp"

namespace fvd {

namespace {

/// result.json, the table of steps, the report.
constexpr std::uint64_t kTexts_bytes = std::uint64_t{2} << 20U;

struct Density {
  std::string_view suffix;
  std::uint64_t bytes_per_pixel;
};
/// Of the largest files there are: two triangles a pixel, a line of text a pixel, floating point numbers.
constexpr std::array kDensities{Density{".stl", 100}, Density{".ply", 50}, Density{".csv", 40}, Density{".x3p", 10},
                                Density{".sdf", 8},   Density{".tiff", 5}, Density{".gsf", 5},  Density{".png", 4}};

std::uint64_t bytes_per_pixel(std::string_view file) {
  for (const Density& density : kDensities) {
    if (file.ends_with(density.suffix)) return density.bytes_per_pixel;
  }
  return 0;
}

}  // namespace

std::uint64_t job_storage_bytes(const Recipe& recipe, int width, int height) {
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  std::uint64_t a_pixel = 0;
  for (const Exporter& exporter : chosen_exporters(recipe.exports)) {
    const std::uint64_t files = exporter.need == ExportNeed::kEachExtraMap ? recipe.extra_peaks.size() : 1;
    if (exporter.name == "step_log.csv") continue;  // of the steps, not of the pixels
    a_pixel += files * bytes_per_pixel(exporter.name);
  }
  if (recipe.keep_slices) {
    a_pixel += static_cast<std::uint64_t>(recipe.slices) * static_cast<std::uint64_t>(recipe.repeat) *
               static_cast<std::uint64_t>(bytes_per_pixel(recipe.camera.slice_format()));
  }
  return a_pixel * pixels + kTexts_bytes;
}

}  // namespace fvd
