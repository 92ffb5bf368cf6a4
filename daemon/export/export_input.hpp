#pragma once

/// The data from which an exporter makes its file.

#include <future>
#include <string>

#include "core/surface/statistics.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

/// context: read by several exporters at the same time.
struct ExportInput {
  const ResultData& data;
  const HeightMap& map;                       ///< data.map, or the map of another peak method
  PeakMethod peak;                            ///< peak method of `map`
  std::shared_future<HeightSummary> summary;  ///< of data.map; the first exporter that asks computes it
};

/// The title of the result for people: its part id, or its job id where there is no part id.
[[nodiscard]] std::string result_title(const ResultData& data);

}  // namespace fvd
