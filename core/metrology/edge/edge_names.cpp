#include "core/metrology/edge/edge_result.hpp"

namespace fvd::metrology {

std::string_view edge_quantity_key(EdgeQuantity quantity) noexcept {
  switch (quantity) {
    case EdgeQuantity::kRadius:
      return "radius_um";
    case EdgeQuantity::kRadiusApparent:
      return "radius_apparent_um";
    case EdgeQuantity::kBeta:
      return "beta_deg";
    case EdgeQuantity::kSGamma:
      return "S_gamma_um";
    case EdgeQuantity::kSAlpha:
      return "S_alpha_um";
    case EdgeQuantity::kK:
      return "K";
    case EdgeQuantity::kDeltaR:
      return "delta_r_um";
    case EdgeQuantity::kPhi:
      return "phi_deg";
    case EdgeQuantity::kRMin:
      return "r_min_um";
    case EdgeQuantity::kResidualRms:
      return "residual_rms_um";
  }
  return {};
}

std::string_view edge_reason_text(EdgeReason reason) noexcept {
  switch (reason) {
    case EdgeReason::kNone:
      return {};
    case EdgeReason::kTooFewPoints:
      return "the region holds too few points for two flanks";
    case EdgeReason::kNotConvex:
      return "the flanks do not meet in a convex edge";
    case EdgeReason::kRakeSideAmbiguous:
      return "the edge runs towards the side on which the rake is said to be";
    case EdgeReason::kFlankUnmeasured:
      return "under half of a flank's points are there";
    case EdgeReason::kApexUnmeasured:
      return "under half of the points between the flanks are there";
    case EdgeReason::kNotConverged:
      return "the model of the rounding found no minimum within the section";
    case EdgeReason::kNoSection:
      return "no section of the edge could be measured";
    case EdgeReason::kBelowResolution:
      return "the rounding is smaller than half a focus window";
    case EdgeReason::kNotCorrected:
      return "the method knows no correction for the focus window";
    case EdgeReason::kNotDefinedByMethod:
      return "the method gives no such value";
    case EdgeReason::kTooFewSections:
      return "one section alone has no spread";
    case EdgeReason::kNoSigma:
      return "the surface does not say its noise";
    case EdgeReason::kEdgeLineTooShort:
      return "too little of the edge line is measured";
  }
  return {};
}

}  // namespace fvd::metrology
