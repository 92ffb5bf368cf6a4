#pragma once

/// Per slice: the commanded and the measured height, and how the axis got there.

#include <chrono>
#include <cstdint>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/units.hpp"

namespace fvd {

/// One slice. Positions in um.
struct StepRecord {
  int index = 0;              ///< 0-based slice of the plan
  bool measured = true;       ///< false: the slice was lost, as the recipe allowed
  double commanded_um = 0.0;  ///< as planned
  double quantised_um = 0.0;  ///< as the drive can represent it
  std::int32_t commanded_counts = 0;
  double measured_um = 0.0;     ///< mean over the exposure; the z that the slice was used with
  double measured_sd_um = 0.0;  ///< standard deviation of the encoder samples inside the exposure
  int position_samples = 0;     ///< encoder samples inside the exposure; 0 = interpolated
  double error_um = 0.0;        ///< measured - quantised
  double move_ms = 0.0;         ///< start of the move to settled
  int settle_polls = 0;
  std::uint64_t frame_id = 0;
  int triggers = 1;  ///< 1 = the first frame was good
  HostTime exposure_start{};
};

using StepLog = std::vector<StepRecord>;

}  // namespace fvd
