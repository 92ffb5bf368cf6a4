#include "daemon/jobs/result_pipeline.hpp"

#include <set>
#include <utility>

#include "daemon/export/result_json.hpp"
#include "daemon/jobs/job_values.hpp"
#include "daemon/result/evaluate.hpp"

namespace fvd {

void note_verdict(const Result& result, std::string& verdict, std::string& reason_codes) {
  if (result.verdict) verdict = verdict_name(*result.verdict);
  if (!result.evaluation) return;
  std::set<int> codes;
  for (const auto& [name, measurement] : result.evaluation->measurements) {
    if (measurement.reason_code != 0) codes.insert(measurement.reason_code);
    if (measurement.verdict == Verdict::kUncertain) codes.insert(evaluation_code::kUncertain);
    if (measurement.verdict == Verdict::kInvalid && measurement.reason_code == 0) {
      codes.insert(evaluation_code::kInvalid);
    }
  }
  for (const int code : codes) reason_codes += (reason_codes.empty() ? "" : ",") + std::to_string(code);
}

JobResult store_result(AtomicDirectory& directory, const ResultData& acquired, FirstFilesWriter* begun) {
  FirstFiles files = begun != nullptr ? begun->finish() : write_first_files(directory, acquired);
  directory.commit();
  JobResult result;
  result.directory = directory.final_dir().string();
  result.text = result_json_text(files.result);
  result.files_pending = !files.is_complete();
  result.written = std::move(files.written);
  if (const auto shortage = shortfall(files.result)) {
    result.error = shortage->code;
    result.message = shortage->message;
  }
  note_verdict(files.result, result.verdict, result.reason_codes);
  result.values = values_of(files.result);
  return result;
}

}  // namespace fvd
