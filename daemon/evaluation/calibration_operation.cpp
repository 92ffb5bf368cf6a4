#include "daemon/evaluation/calibration_operation.hpp"

#include "core/base/error.hpp"
#include "core/metrology/operations/lateral.hpp"
#include "core/metrology/operations/rearrange.hpp"

namespace fvd {

double z_amplification(const EvaluationContext& context) noexcept {
  return context.calibration && context.calibration->z ? context.calibration->z->alpha_z : 1.0;
}

void divide_heights(double alpha_z, metrology::HeightField& field) {
  for (double& z_um : field.z_um.pixels()) z_um /= alpha_z;
  for (float& sigma_um : field.sigma_um.pixels()) {
    sigma_um = static_cast<float>(static_cast<double>(sigma_um) / alpha_z);
  }
}

std::string missing_calibration(const PlannedOperation& step, const EvaluationContext& context) {
  const bool lateral = step.op == "lateral";
  if (!lateral && step.op != "flatness_reference") return {};
  if (!context.calibration) {
    return std::string("there is no calibration of this instrument and objective: make one with fvdctl calibrate ") +
           (lateral ? "lateral" : "flatness") + " and accept it, or take the step out of the recipe";
  }
  const Calibration& calibration = *context.calibration;
  if (lateral && !calibration.lateral) {
    return "the calibration " + calibration.id +
           " has no lateral constants: find them with fvdctl calibrate lateral and accept them, or take the step out "
           "of the recipe";
  }
  if (lateral || context.flatness_reference != nullptr) return {};
  if (!calibration.flatness || calibration.flatness->reference.empty()) {
    return "the calibration " + calibration.id +
           " has no reference map: make one with fvdctl calibrate flatness and accept it, or take the step out of the "
           "recipe";
  }
  return "the reference map " + calibration.flatness->reference + " of the calibration " + calibration.id +
         " is not at hand: say its folder with --calibration";
}

metrology::OperationReport lateral_operation(const EvaluationContext& context, Plane<MaskReasons>* reasons,
                                             metrology::HeightField& field) {
  const LateralConstants& constants = context.calibration->lateral.value();
  try {
    return metrology::lateral(field, {constants.pitch_x_um, constants.pitch_y_um, constants.shear}, reasons);
  } catch (const Error& error) {  // out of range, which the file of the constants allows
    return metrology::refusal(error.what());
  }
}

metrology::OperationReport flatness_operation(const EvaluationContext& context, Plane<MaskReasons>* reasons,
                                              metrology::HeightField& field) {
  const metrology::HeightField& map = *context.flatness_reference;
  const double alpha_z = z_amplification(context);
  if (alpha_z == 1.0) return metrology::flatness_reference(field, map, reasons);
  metrology::HeightField divided = map.clone();
  divide_heights(alpha_z, divided);
  return metrology::flatness_reference(field, divided, reasons);
}

}  // namespace fvd
