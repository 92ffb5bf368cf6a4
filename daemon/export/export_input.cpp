#include "daemon/export/export_input.hpp"

namespace fvd {

std::string result_title(const ResultData& data) {
  if (!data.part_id.empty()) return data.part_id;
  return data.job_id.empty() ? "height map" : data.job_id;
}

}  // namespace fvd
