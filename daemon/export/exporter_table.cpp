#include "daemon/export/exporter_table.hpp"

#include <algorithm>
#include <array>

#include "daemon/export/gsf.hpp"
#include "daemon/export/height_tiff.hpp"
#include "daemon/export/mask_png.hpp"
#include "daemon/export/preview.hpp"
#include "daemon/export/step_csv.hpp"
#include "daemon/export/texture_png.hpp"

namespace fvd {

std::span<const Exporter> exporter_table() {
  using enum ExportNeed;
  using enum ExportCost;
  static constexpr std::array kExporters{
      Exporter{"height.tiff", kResult, kQuick, height_tiff_file},
      Exporter{"height_*.tiff", kEachExtraMap, kQuick, height_tiff_file},
      Exporter{"sigma.tiff", kResult, kQuick, sigma_tiff_file},
      Exporter{"height_smooth.tiff", kSmoothedMap, kQuick, smooth_height_tiff_file},
      Exporter{"sigma_smooth.tiff", kSmoothedMap, kQuick, smooth_sigma_tiff_file},
      Exporter{"height.gsf", kResult, kQuick, gsf_file},
      Exporter{"mask.png", kResult, kQuick, mask_png_file},
      Exporter{"texture.png", kResult, kQuick, texture_png_file},
      Exporter{"preview.png", kResult, kSlow, preview_file},
      Exporter{"step_log.csv", kResult, kQuick, step_csv_file},
  };
  return kExporters;
}

std::vector<Exporter> chosen_exporters(const std::optional<std::vector<std::string>>& names) {
  std::vector<Exporter> chosen;
  for (const Exporter& exporter : exporter_table()) {
    if (!names || std::find(names->begin(), names->end(), exporter.name) != names->end()) chosen.push_back(exporter);
  }
  return chosen;
}

}  // namespace fvd
