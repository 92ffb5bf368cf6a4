#pragma once

/// From what was acquired to the result with its verdict: before anything of it is written.

#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/surface/statistics.hpp"
#include "daemon/result/result.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

/// summary: of data.map. The result lacks its files and how long they took. Heights of the further maps are counted
/// here.
[[nodiscard]] Result evaluate(const ResultData& data, const HeightSummary& summary);

/// The worst of the map's values and of the evaluation; absent where neither is judged.
[[nodiscard]] std::optional<Verdict> verdict_of(const Result& result);

/// Why a job fails though it has a result.
struct Shortfall {
  ErrorCode code;
  std::string message;
};

/// Fewer points are valid than the recipe asks for: kFocusRange where most of the others are sharpest at an end of the
/// scan, else kTooFewValid; nothing where the result is as good as was asked for.
[[nodiscard]] std::optional<Shortfall> shortfall(const Result& result);

}  // namespace fvd
