#include "daemon/export/result_writer.hpp"

#include <chrono>
#include <future>
#include <string>

#include "daemon/export/gsf.hpp"
#include "daemon/export/height_tiff.hpp"
#include "daemon/export/image_png.hpp"
#include "daemon/export/preview.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/step_csv.hpp"

namespace fvd {

namespace {

std::string title(const ResultData& data) {
  if (!data.part_id.empty()) return data.part_id;
  return data.job_id.empty() ? "height map" : data.job_id;
}

TiffTags tiff_tags(const ResultData& data, PeakMethod method, const std::string& quantity = "height") {
  return {data.software_version,
          title(data) + ": " + quantity + " in metres, NaN where invalid, peak " +
              std::string(peak_method_name(method)) + (data.simulated ? ", SIMULATED" : ""),
          data.pixel_pitch_x_um, data.pixel_pitch_y_um};
}

GsfHeader gsf_header(const ResultData& data) {
  GsfHeader header{title(data), data.pixel_pitch_x_um, data.pixel_pitch_y_um, {}};
  const auto add = [&header](const char* key, const std::string& value) {
    if (!value.empty()) header.metadata.emplace_back(key, value);
  };
  add("PartId", data.part_id);
  add("JobId", data.job_id);
  add("Recipe", data.recipe_id);
  add("RecipeSha256", data.recipe_sha256);
  add("Peak", std::string(peak_method_name(data.peak)));
  add("Software", data.software_version);
  add("Source", data.source);
  add("Simulated", data.simulated ? "true" : "false");
  return header;
}

PreviewText preview_text(const ResultData& data, const HeightSummary& summary) {
  const auto tenths = static_cast<long>(summary.valid_fraction() * 1000);  // rounded down: 100 % means all
  PreviewText text;
  text.title = title(data);
  text.subtitle = (data.recipe_id.empty() ? "" : "recipe " + data.recipe_id + ", ") +
                  std::to_string(data.steps.size()) + " slices, window " + std::to_string(data.focus.window_px) +
                  " px, " + std::string(peak_method_name(data.peak)) + ", " + std::to_string(tenths / 10) + "." +
                  std::to_string(tenths % 10) + " % valid";
  text.simulated = data.simulated;
  text.pitch_x_um = data.pixel_pitch_x_um.value_or(0.0);
  return text;
}

struct Preview {
  HeightSummary summary;
  std::string png;
};

}  // namespace

HeightSummary write_result(AtomicDirectory& directory, const ResultData& data) {
  const auto start = std::chrono::steady_clock::now();
  // What takes longest runs beside the rest, on one thread.
  auto drawing = std::async(std::launch::async, [&data] {
    Preview preview{summarize_heights(data.map.height_m, data.map.sigma_m, data.map.mask), {}};
    preview.png = encode_preview_png(data.map, preview.summary, preview_text(data, preview.summary));
    return preview;
  });
  directory.add_file("height.tiff", encode_height_tiff(data.map.height_m, tiff_tags(data, data.peak)));
  for (const auto& [method, map] : data.extra_maps) {
    directory.add_file("height_" + std::string(peak_method_name(method)) + ".tiff",
                       encode_height_tiff(map.height_m, tiff_tags(data, method)));
  }
  directory.add_file("sigma.tiff", encode_height_tiff(data.map.sigma_m, tiff_tags(data, data.peak, "standard error")));
  directory.add_file("height.gsf", encode_gsf(data.map.height_m, gsf_header(data)));
  directory.add_file("mask.png", encode_mask_png(data.map));
  directory.add_file("texture.png", encode_texture_png(data.map));
  const Preview preview = drawing.get();
  directory.add_file("preview.png", preview.png);
  directory.add_file("step_log.csv", step_csv(data.steps));
  const double write_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  directory.add_file("result.json", result_json_text(data, preview.summary, WriteReport{directory.files(), write_ms}));
  return preview.summary;
}

HeightSummary write_result(const std::filesystem::path& final_dir, const ResultData& data) {
  AtomicDirectory directory(final_dir);
  const HeightSummary summary = write_result(directory, data);
  directory.commit();
  return summary;
}

}  // namespace fvd
