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
  /// As result.json tells it, but for its files; the first exporter that asks computes it.
  std::shared_future<Result> result = {};
  std::string measurement = {};  ///< of a file of one measurement: its name
};

/// data: outlives the input.
[[nodiscard]] ExportInput export_input(const ResultData& data);
/// Of a result that was read back. data: what result_data() made of it and its planes.
[[nodiscard]] ExportInput export_input(const ResultData& data, const Result& result);

/// What exporters that follow read of a result's data; without planes.
[[nodiscard]] ResultData result_data(const Result& result);

/// The title of the result for people: its part id, or its job id where there is no part id.
[[nodiscard]] std::string result_title(const ResultData& data);

}  // namespace fvd
