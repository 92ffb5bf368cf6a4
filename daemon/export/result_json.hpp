#pragma once

/// result.json: everything about a result except its pixels.

#include <optional>
#include <string>
#include <vector>

#include "core/surface/statistics.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/result_data.hpp"

namespace fvd {

/// What is known only once the other files are written.
struct WriteReport {
  std::vector<AtomicDirectory::File> files;
  double write_ms = 0.0;
};

/// Pretty-printed JSON, ASCII only, keys in a fixed order, null for whatever is unknown or not finite; heights rounded
/// to 0.1 nm. With a report also "files" and times.write_ms.
[[nodiscard]] std::string result_json_text(const ResultData& data, const HeightSummary& summary,
                                           const std::optional<WriteReport>& report = {});

}  // namespace fvd
