#include "core/stage/stage_point.hpp"

#include <cmath>
#include <string>

#include "core/base/error.hpp"

namespace fvd {

namespace {

void require(bool good, const std::string& what) {
  if (!good) throw Error(ErrorCode::kBadInput, "stage report: " + what);
}

}  // namespace

void check_stage_points(const std::vector<StagePoint>& points, const StageReportOptions& options) {
  const auto length = [](double value) { return std::isfinite(value) && value >= 0.0; };
  // Beyond, a double no longer tells nanometres apart.
  const auto position = [](double value) { return std::abs(value) <= kLargestPositionUm; };
  require(length(options.step_quantum_um), "step_quantum_um is not a length (0 = unknown)");
  require(length(options.feedback_resolution_um), "feedback_resolution_um is not a length (0 = unknown)");
  require(!options.lead_um || (std::isfinite(*options.lead_um) && *options.lead_um > 0.0),
          "lead_um must be above 0 where it is given");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const StagePoint& p = points[i];
    const auto check = [i](bool good, const char* field) {
      require(good, "point " + std::to_string(i) + ": " + field + " cannot be used");
    };
    check(std::isfinite(p.time_s), "time_s");
    check(p.run >= 0, "run");
    check(p.direction == 1 || p.direction == -1, "direction");
    check(position(p.commanded_um), "commanded_um");
    check(position(p.quantised_um), "quantised_um");
    check(options.feedback == FeedbackSource::kNone || position(p.measured_um), "measured_um");
    check(length(p.settle_ms), "settle_ms");
    check(length(p.move_ms), "move_ms");
    check(p.polls >= 0, "polls");
    check(!p.temperature_c || std::isfinite(*p.temperature_c), "temperature_c");
  }
}

}  // namespace fvd
