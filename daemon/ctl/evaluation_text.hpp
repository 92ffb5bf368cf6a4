#pragma once

/// An evaluation as lines for people.

#include <optional>
#include <string>

#include "core/surface/verdict.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd::ctl {

/// A block for each measurement in the recipe's order: values with U and verdict, reasons and warnings below them.
[[nodiscard]] std::string evaluation_text(const Evaluation& evaluation);

/// kExitOk of pass and where nothing was judged, else kExitVerdictFail, -Uncertain or -Invalid.
[[nodiscard]] int exit_code_of(std::optional<Verdict> verdict) noexcept;

}  // namespace fvd::ctl
