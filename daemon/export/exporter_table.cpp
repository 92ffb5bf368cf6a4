#include "daemon/export/exporter_table.hpp"

#include <algorithm>
#include <array>

#include "daemon/export/gsf.hpp"
#include "daemon/export/height_tiff.hpp"
#include "daemon/export/mask_png.hpp"
#include "daemon/export/picture_exporters.hpp"
#include "daemon/export/preview.hpp"
#include "daemon/export/step_csv.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/export/texture_png.hpp"

namespace fvd {

namespace {

/// A writer of surface files as an exporter.
template <void (*write)(const SurfaceView&, const ByteSink&)>
void surface_file(const ExportInput& input, const ByteSink& sink) {
  write_surface({"the file", {}, true, false, write}, surface_view(input), sink);
}

}  // namespace

std::span<const Exporter> exporter_table() {
  using enum ExportNeed;
  using enum ExportCost;
  static constexpr std::array kExporters{
      Exporter{"height.tiff", kResult, kQuick, height_tiff_file, nullptr, "tiff"},
      Exporter{"height_*.tiff", kEachExtraMap, kQuick, height_tiff_file},
      Exporter{"sigma.tiff", kResult, kQuick, sigma_tiff_file, nullptr, "tiff"},
      Exporter{"height_smooth.tiff", kSmoothedMap, kQuick, smooth_height_tiff_file},
      Exporter{"sigma_smooth.tiff", kSmoothedMap, kQuick, smooth_sigma_tiff_file},
      Exporter{"repeat_sd.tiff", kRepeatedScans, kQuick, repeat_sd_tiff_file},
      Exporter{"repeat_sd.gsf", kRepeatedScans, kQuick, repeat_sd_gsf_file, nullptr, "gsf", true},
      Exporter{"height.gsf", kResult, kQuick, gsf_file, nullptr, "gsf"},
      Exporter{"sigma.gsf", kResult, kQuick, nullptr, surface_file<write_sigma_gsf>, "gsf", true},
      Exporter{"mask.png", kResult, kQuick, mask_png_file},
      Exporter{"texture.png", kResult, kQuick, texture_png_file},
      Exporter{"preview.png", kResult, kSlow, preview_file},
      Exporter{"step_log.csv", kResult, kQuick, step_csv_file},
      Exporter{"height.x3p", kResult, kQuick, nullptr, surface_file<write_x3p>, "x3p", true},
      Exporter{"height.sdf", kResult, kQuick, nullptr, surface_file<write_sdf>, "sdf", true},
      Exporter{"height.ply", kResult, kSlow, nullptr, surface_file<write_ply>, "ply", true},
      Exporter{"height.stl", kResult, kSlow, nullptr, surface_file<write_stl>, "stl", true},
      Exporter{"height.csv", kResult, kSlow, nullptr, surface_file<write_csv>, "csv", true},
      Exporter{"sigma.png", kResult, kSlow, sigma_picture_file, nullptr, {}, true},
      Exporter{"holes.png", kResult, kSlow, holes_picture_file, nullptr, {}, true},
      Exporter{"view3d.png", kResult, kSlow, view_picture_file, nullptr, {}, true},
      Exporter{"report.pdf", kResult, kSlow, report_file, nullptr, {}, true},
  };
  return kExporters;
}

std::vector<Exporter> chosen_exporters(const std::optional<std::vector<std::string>>& names) {
  std::vector<Exporter> chosen;
  const auto is_named = [&names](std::string_view name) {
    return !name.empty() && std::find(names->begin(), names->end(), name) != names->end();
  };
  for (const Exporter& exporter : exporter_table()) {
    const bool wanted = names ? is_named(exporter.name) || is_named(exporter.format) : !exporter.on_request;
    if (wanted) chosen.push_back(exporter);
  }
  return chosen;
}

std::string bytes_of(const Exporter& exporter, const ExportInput& input) {
  if (exporter.stream == nullptr) return exporter.encode(input);
  std::string bytes;
  exporter.stream(input, [&bytes](std::string_view piece) { bytes += piece; });
  return bytes;
}

}  // namespace fvd
