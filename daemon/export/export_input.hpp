#pragma once

/// What an exporter makes its file of.

#include <future>
#include <string>

#include "core/surface/statistics.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

/// context: read by several exporters at the same time.
struct ExportInput {
  const ResultData& data;
  const HeightMap& map;                       ///< data.map, or the further map the file is for
  PeakMethod peak;                            ///< of that map
  std::shared_future<HeightSummary> summary;  ///< of data.map; the first who asks computes it
};

/// What a person calls the result: its part, else its job.
[[nodiscard]] std::string result_title(const ResultData& data);

}  // namespace fvd
