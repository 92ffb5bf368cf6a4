#include "daemon/jobs/result_pipeline.hpp"

#include "config/strict_json.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/pipeline/measurement.hpp"

namespace fvd {

JobResult store_result(AtomicDirectory& directory, const Recipe& recipe, const ResultData& acquired) {
  write_result(directory, acquired);
  directory.commit();
  JobResult result;
  result.directory = directory.final_dir().string();
  result.text = read_text_file(directory.final_dir() / "result.json");
  try {
    check_valid_points(recipe, acquired.map);
  } catch (const Error& error) {
    result.error = error.code();
    result.message = error.what();
  }
  return result;
}

}  // namespace fvd
