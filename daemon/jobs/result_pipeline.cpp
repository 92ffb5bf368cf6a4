#include "daemon/jobs/result_pipeline.hpp"

#include <utility>

#include "daemon/export/result_json.hpp"
#include "daemon/result/evaluate.hpp"

namespace fvd {

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
  return result;
}

}  // namespace fvd
