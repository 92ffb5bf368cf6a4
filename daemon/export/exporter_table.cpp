#include "daemon/export/exporter_table.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "daemon/export/gsf.hpp"
#include "daemon/export/height_tiff.hpp"
#include "daemon/export/mask_png.hpp"
#include "daemon/export/picture_exporters.hpp"
#include "daemon/export/step_csv.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/export/texture_png.hpp"
#include "daemon/report/measurement_pictures.hpp"

namespace fvd {

namespace {

/// A writer of surface files as an exporter.
template <void (*write)(const SurfaceView&, const ByteSink&)>
void surface_file(const ExportInput& input, const ByteSink& sink) {
  write_surface({"the file", {}, true, false, write}, surface_view(input), sink);
}

std::string with_name(std::string_view file, std::string_view name) {
  std::string text(file);
  const auto place = text.find('*');
  return place == std::string::npos ? text : text.replace(place, 1, name);
}

/// In the recipe's order.
std::vector<std::pair<std::string, const EvaluatedMeasurement*>> measurements_of(const ExportInput& input) {
  std::vector<std::pair<std::string, const EvaluatedMeasurement*>> list;
  const std::optional<Evaluation>& evaluation = input.data.evaluation;
  if (!evaluation) return list;
  for (const std::string& name : evaluation->order) {
    const auto found = evaluation->measurements.find(name);
    if (found != evaluation->measurements.end()) list.emplace_back(name, &found->second);
  }
  return list;
}

/// Makes one that holds these planes the first of all where none of the first ones does.
void take_forward(ResultPlanes planes, DividedExporters& exporters) {
  const auto holds = [planes](const Exporter& exporter) { return (exporter.holds & planes) == planes; };
  if (std::any_of(exporters.first.begin(), exporters.first.end(), holds)) return;
  const auto found = std::find_if(exporters.following.begin(), exporters.following.end(), holds);
  if (found == exporters.following.end()) return;
  exporters.first.push_back(*found);
  exporters.following.erase(found);
}

}  // namespace

std::span<const Exporter> exporter_table() {
  using enum ExportNeed;
  using enum ExportCost;
  using enum ExportTime;
  using namespace result_planes;
  constexpr ResultPlanes kMeshed = kHeights | kSigma | kTexture;
  static constexpr std::array kExporters{
      Exporter{"height.tiff", kResult, kQuick, height_tiff_file, nullptr, "tiff", false, kVerdict, 0, kHeights},
      Exporter{"height_*.tiff", kEachExtraMap, kQuick, height_tiff_file},
      Exporter{"sigma.tiff", kResult, kQuick, sigma_tiff_file, nullptr, "tiff", false, kVerdict, 0, kSigma},
      Exporter{"height_smooth.tiff", kSmoothedMap, kQuick, smooth_height_tiff_file},
      Exporter{"sigma_smooth.tiff", kSmoothedMap, kQuick, smooth_sigma_tiff_file},
      Exporter{"repeat_sd.tiff", kRepeatedScans, kQuick, repeat_sd_tiff_file},
      Exporter{"repeat_sd.gsf", kRepeatedScans, kQuick, repeat_sd_gsf_file, nullptr, "gsf", true},
      Exporter{"height.gsf", kResult, kQuick, gsf_file, nullptr, "gsf", false, kFollows, kHeights, kHeights},
      Exporter{"sigma.gsf", kResult, kQuick, nullptr, surface_file<write_sigma_gsf>, "gsf", true, kFollows,
               kHeights | kSigma, kSigma},
      Exporter{"mask.png", kResult, kQuick, mask_png_file, nullptr, {}, false, kVerdict, 0, kMask},
      Exporter{"texture.png", kResult, kQuick, texture_png_file, nullptr, {}, false, kVerdict, 0, kTexture},
      Exporter{"preview.png", kResult, kSlow, preview_file, nullptr, {}, false, kFollows, kHeights},
      Exporter{
          "texture_view.png", kResult, kSlow, texture_view_file, nullptr, {}, false, kFollows, kHeights | kTexture},
      Exporter{"profile_*.png", kEachSection, kSlow, profile_picture_file, nullptr, {}, false, kFollows, kHeights},
      Exporter{"edge.png", kCuttingEdges, kSlow, edge_picture_file, nullptr, {}, false, kFollows, kHeights},
      Exporter{"step_log.csv", kResult, kQuick, step_csv_file},
      Exporter{"height.x3p", kResult, kQuick, nullptr, surface_file<write_x3p>, "x3p", true, kFollows, kHeights,
               kHeights},
      Exporter{"height.sdf", kResult, kQuick, nullptr, surface_file<write_sdf>, "sdf", true, kFollows, kHeights,
               kHeights},
      Exporter{"height.ply", kResult, kSlow, nullptr, surface_file<write_ply>, "ply", true, kFollows, kMeshed},
      Exporter{"height.stl", kResult, kSlow, nullptr, surface_file<write_stl>, "stl", true, kFollows, kHeights},
      Exporter{"height.csv", kResult, kSlow, nullptr, surface_file<write_csv>, "csv", true, kFollows, kHeights},
      Exporter{"sigma.png", kResult, kSlow, sigma_picture_file, nullptr, {}, true, kFollows, kHeights | kSigma},
      Exporter{"holes.png", kResult, kSlow, holes_picture_file, nullptr, {}, true, kFollows, kHeights | kMask},
      Exporter{"view3d.png", kResult, kSlow, view_picture_file, nullptr, {}, true, kFollows, kHeights},
      Exporter{"report.pdf", kResult, kSlow, report_file, nullptr, {}, true, kFollows, kHeights},
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

std::vector<ExportFile> export_files(const Exporter& exporter, const ExportInput& of_result) {
  std::vector<ExportFile> files;
  switch (exporter.need) {
    case ExportNeed::kResult:
      files.push_back({std::string(exporter.name), of_result});
      break;
    case ExportNeed::kSmoothedMap:
      if (of_result.data.smoothed) files.push_back({std::string(exporter.name), of_result});
      break;
    case ExportNeed::kRepeatedScans:
      if (of_result.data.repeated) files.push_back({std::string(exporter.name), of_result});
      break;
    case ExportNeed::kEachExtraMap:
      for (const auto& [method, map] : of_result.data.extra_maps) {
        files.push_back({with_name(exporter.name, peak_method_name(method)),
                         {of_result.data, map, method, of_result.summary, of_result.result}});
      }
      break;
    case ExportNeed::kEachSection:
      for (const auto& [name, measurement] : measurements_of(of_result)) {
        if (!measurement->cross_section) continue;
        files.push_back({with_name(exporter.name, name), of_result});
        files.back().input.measurement = name;
      }
      break;
    case ExportNeed::kCuttingEdges: {
      const auto measurements = measurements_of(of_result);
      const bool any = std::any_of(measurements.begin(), measurements.end(),
                                   [](const auto& named) { return is_cutting_edge(*named.second); });
      if (any) files.push_back({std::string(exporter.name), of_result});
      break;
    }
  }
  return files;
}

DividedExporters divided(const std::vector<Exporter>& exporters) {
  DividedExporters divided;
  for (const Exporter& exporter : exporters) {
    (exporter.time == ExportTime::kVerdict ? divided.first : divided.following).push_back(exporter);
  }
  take_forward(result_planes::kHeights, divided);
  take_forward(result_planes::kSigma, divided);
  ResultPlanes held = 0;
  for (const Exporter& exporter : divided.first) held |= exporter.holds;
  const auto is_made_of_files = [held](const Exporter& exporter) { return (exporter.reads & ~held) == 0; };
  const auto rest = std::stable_partition(divided.following.begin(), divided.following.end(), is_made_of_files);
  divided.first.insert(divided.first.end(), rest, divided.following.end());
  divided.following.erase(rest, divided.following.end());
  return divided;
}

std::string bytes_of(const Exporter& exporter, const ExportInput& input) {
  if (exporter.stream == nullptr) return exporter.encode(input);
  std::string bytes;
  exporter.stream(input, [&bytes](std::string_view piece) { bytes += piece; });
  return bytes;
}

}  // namespace fvd
