#include "daemon/jobs/result_pipeline.hpp"

#include "daemon/export/result_json.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/result/evaluate.hpp"

namespace fvd {

JobResult store_result(AtomicDirectory& directory, const ResultData& acquired) {
  const Result written = write_result(directory, acquired);
  directory.commit();
  JobResult result;
  result.directory = directory.final_dir().string();
  result.text = result_json_text(written);
  if (const auto shortage = shortfall(written)) {
    result.error = shortage->code;
    result.message = shortage->message;
  }
  return result;
}

}  // namespace fvd
