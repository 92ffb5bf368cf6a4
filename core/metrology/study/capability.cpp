#include "core/metrology/study/capability.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

double in_quadrature(std::initializer_list<double> parts) {
  double squares = 0.0;
  for (const double part : parts) squares += part * part;
  return std::sqrt(squares);
}

}  // namespace

Capability capability(const GaugeType1& type1, std::optional<double> resolution, const GaugeRr& rr,
                      const CapabilityInputs& inputs) {
  if (!(inputs.tolerance > 0.0)) throw Error(ErrorCode::kBadInput, "the tolerance of a capability must be above 0");
  const double from_resolution = resolution.value_or(0.0) / std::sqrt(12.0);
  const double from_bias = std::abs(type1.bias) / std::sqrt(3.0);
  const double on_reference = std::max(type1.sd, from_resolution);
  const double on_parts = std::max(on_reference, rr.ev);

  Capability result;
  result.u_system = in_quadrature({inputs.calibration, on_reference, from_bias, inputs.linearity, inputs.rest_system});
  result.u_process =
      in_quadrature({inputs.calibration, on_parts, from_bias, inputs.linearity, rr.av, rr.interaction, inputs.stability,
                     inputs.object, inputs.temperature, inputs.rest_system, inputs.rest_process});
  result.q_system_percent = 100.0 * 2.0 * inputs.k * result.u_system / inputs.tolerance;
  result.q_process_percent = 100.0 * 2.0 * inputs.k * result.u_process / inputs.tolerance;
  result.system_capable = result.q_system_percent <= 15.0;
  result.process_capable = result.q_process_percent <= 30.0;
  return result;
}

}  // namespace fvd::metrology
