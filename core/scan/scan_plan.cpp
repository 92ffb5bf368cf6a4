#include "core/scan/scan_plan.hpp"

#include <sstream>

#include "core/error.hpp"

namespace fvd {

void check_plan(const ScanPlan& plan, const StageInfo& stage) {
  const Micrometers lowest = plan.start - stage.take_up;
  const Micrometers highest = plan.last();
  if (lowest >= stage.min && highest <= stage.max) return;
  std::ostringstream message;
  message << "the scan from " << plan.start.value << " um to " << highest.value << " um with a take-up of "
          << stage.take_up.value << " um below needs " << lowest.value << ".." << highest.value
          << " um, the stage may travel " << stage.min.value << ".." << stage.max.value
          << " um: change the recipe's range or the stage's limits";
  throw Error(ErrorCode::kStageLimit, message.str());
}

}  // namespace fvd
