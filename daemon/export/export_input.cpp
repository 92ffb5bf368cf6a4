#include "daemon/export/export_input.hpp"

#include "daemon/export/result_json.hpp"
#include "daemon/result/evaluate.hpp"

namespace fvd {

namespace {

std::shared_future<HeightSummary> summary_of(const ResultData& data) {
  return std::async(std::launch::deferred,
                    [&data] { return summarize_heights(data.map.height_m, data.map.sigma_m, data.map.mask); });
}

}  // namespace

ExportInput export_input(const ResultData& data) {
  ExportInput input{data, data.map, data.peak, summary_of(data)};
  // With the roundings of result.json, so that a picture is the same whenever it is made.
  input.result = std::async(std::launch::deferred, [&data, summary = input.summary] {
    return read_result_json(result_json_text(evaluate(data, summary.get())));
  });
  return input;
}

ExportInput export_input(const ResultData& data, const Result& result) {
  ExportInput input{data, data.map, data.peak, summary_of(data)};
  input.result = std::async(std::launch::deferred, [result] { return result; });
  return input;
}

ResultData result_data(const Result& result) {
  ResultData data;
  data.software_version = result.provenance.software_version;
  data.created = result.provenance.created;
  data.simulated = result.provenance.simulated;
  data.source = result.provenance.source;
  data.job_id = result.job.id;
  data.seq = result.job.seq;
  data.part_id = result.job.part_id;
  data.recipe_id = result.recipe.id;
  data.recipe_sha256 = result.recipe.sha256;
  data.focus = result.focus.settings;
  data.peak = result.focus.peak;
  data.pixel_pitch_x_um = result.focus.pixel_pitch_x_um;
  data.pixel_pitch_y_um = result.focus.pixel_pitch_y_um;
  data.step_summary = result.steps;
  data.times = result.times;
  data.evaluation = result.evaluation;
  return data;
}

std::string result_title(const ResultData& data) {
  if (!data.part_id.empty()) return data.part_id;
  return data.job_id.empty() ? "height map" : data.job_id;
}

}  // namespace fvd
