#pragma once

/// What the instrument's constants, the temperature and gauge studies add to a value's budget.

#include <string>
#include <vector>

#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/evaluation/value_uncertainty.hpp"

namespace fvd {

/// Adds to a value's budget what is known and applies to it; p_z and p_xy are its value_powers(), v the value. To be
/// called when the entries of its noise are there: without one, and without a gauge study, nothing is added, for the
/// instrument's constants alone would pass for all of U.
///
/// repeatability, type A: sqrt(max(0, sd^2 - sum of the other entries of type A)^2)) with the study's dof: what
/// scatters
///   from scan to scan and noise does not explain. A scatter of 0 is no uncertainty where nothing else is known. Own
///   definition.
/// alpha_z: |p_z v| u(alpha_z) / alpha_z. Not of cutting edges, where flanks of unknown angle mix x and z.
/// l_z, of steps and levels: l_z / sqrt 3, rectangular; 0 is not known, as from one step.
/// lead, of steps and levels, where the screw's periodic error of amplitude A and period L is known, its phase at the
///   part not: sqrt 2 A |sin(pi h / L)|, the quadratic mean over all phases of the difference of two places h apart.
///   Own definition.
/// flatness, of steps and levels: z_FLT / (2 sqrt 3), as each place may lie anywhere within z_FLT; where the reference
///   map was subtracted, its u_reference_um.
/// lateral: |p_xy v| r, where r^2 = larger (u(pitch) / pitch)^2 of both directions + d^2 / 3, and d is by how much the
///   surface's pitch differs from the calibrated one: 0 behind the operation `lateral`. Own definition.
/// temperature: |p_z + p_xy| |v| expansion |T - 20 deg C| / sqrt 3, rectangular: values are not corrected to the
///   reference temperature of ISO 1.
/// reproducibility, of texture heights (p_z = 1, p_xy = 0): percent of the value.
/// context: pure, as the next one.
void add_instrument(const MeasurementInput& input, const std::string& key, ValueInput& value);

/// Sources of which nothing is known, or which the budgets of this kind of measurement do not contain.
[[nodiscard]] std::vector<std::string> instrument_not_evaluated(const MeasurementInput& input);

}  // namespace fvd
