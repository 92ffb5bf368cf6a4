#include "daemon/pipeline/evaluation_record.hpp"

#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/json_values.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/pipeline/evaluation_input.hpp"
#include "daemon/report/report_pdf.hpp"
#include "daemon/report/surface_digest.hpp"
#include "daemon/result/evaluate.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

ordered_json source_json(const StoredSurface& source) {
  const Result& result = source.result;
  return {{"job_id", text_or_null(result.job.id)},
          {"recipe", {{"id", text_or_null(result.recipe.id)}, {"sha256", text_or_null(result.recipe.sha256)}}},
          {"verdict", result.verdict ? ordered_json(verdict_name(*result.verdict)) : ordered_json(nullptr)},
          {"software_version", text_or_null(result.provenance.software_version)},
          {"surface_sha256", surface_sha256(source.surface.height_m.view())}};
}

Result evaluated(const StoredSurface& source, const Recipe& recipe, const EvaluationRecordHead& head,
                 WorkerPool* pool) {
  const auto start = std::chrono::steady_clock::now();
  Result result = source.result;
  result.job.id = head.id;
  result.recipe = {recipe.id, recipe.sha256};
  result.provenance.software_version = head.software_version;
  EvaluationContext context = source.context;
  keep_repeatability_of(recipe, source.result, context);
  result.repeatability = context.repeatability;
  result.evaluation = evaluate_surface(source.surface, recipe.evaluation, context, pool);
  result.verdict = verdict_of(result);
  result.times.evaluate_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  result.files.clear();
  return result;
}

}  // namespace

EvaluationRecord write_evaluation_record(AtomicDirectory& directory, const StoredSurface& source, const Recipe& recipe,
                                         const EvaluationRecordHead& head, WorkerPool* pool) {
  Result result = evaluated(source, recipe, head, pool);
  if (recipe.report.pdf.value_or(true)) {
    directory.add_file("report.pdf", report_pdf(result, picture_surface(source.surface)));
    ResultFile listed;
    listed.name = "report.pdf";
    listed.size_bytes = directory.files().back().size_bytes;
    result.files.push_back(std::move(listed));
  }
  ordered_json json = ordered_json::parse(result_json_text(result));
  json["evaluated"] = iso8601_utc(head.evaluated);
  json["source"] = source_json(source);
  EvaluationRecord record;
  record.verdict = result.verdict;
  record.json = json.dump(2, ' ', true, ordered_json::error_handler_t::replace) + "\n";
  directory.add_file("result.json", record.json);
  return record;
}

}  // namespace fvd
