#include "core/metrology/step/refusal.hpp"

namespace fvd::metrology {

const char* step_refusal_name(StepRefusalCode code) noexcept {
  switch (code) {
    case StepRefusalCode::kTooFewValid:
      return "too_few_valid";
    case StepRefusalCode::kNoEdges:
      return "no_edges";
    case StepRefusalCode::kTooFewTraces:
      return "too_few_traces";
    case StepRefusalCode::kOutside:
      return "outside";
    case StepRefusalCode::kOverlap:
      return "overlap";
    case StepRefusalCode::kNoSlope:
      return "no_slope";
    case StepRefusalCode::kNotRounded:
      return "not_rounded";
  }
  return "too_few_valid";
}

}  // namespace fvd::metrology
