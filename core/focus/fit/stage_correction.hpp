#pragma once

/// The stage's errors, seen in the focus curves themselves.
///
/// An error of a slice's z is the same for every pixel. Five samples of a curve lie on one parabola of G = -F^-1/2, see
/// five_sample_fit.hpp; the residuals show the error of each slice, in units of the parabola's slope there. Thousands
/// of curves whose peaks cover the range give one linear system for the offsets of all slices. Components that grow
/// with z or its square are removed: a shift and a stretch leave no residuals, and curves that lean to one side look
/// like an offset that grows with the square of z. The idea, for confocal stacks: G. Zhukova, C. Artigas, G. Carles,
/// "Computational self-corrected quantitative 3D topographic imaging"; here with five samples per pixel instead of the
/// stack.
///
/// Residuals of curves of another shape depend on the fraction of a step and average out only if peaks lie at all
/// fractions. The system is therefore solved only if they do, and used only if the offsets exceed their standard error.

#include <span>
#include <string>
#include <vector>

#include "core/focus/fit/curve_tuple.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// The stage's errors as found in a scan.
struct StageCorrection {
  bool applied = false;
  std::string reason;              ///< why the correction was not applied; empty if it was
  double rms_um = 0.0;             ///< RMS of the offsets found; 0 if the system was not solved
  double standard_error_um = 0.0;  ///< of one offset
  std::vector<double> offsets_um;  ///< to be added to each sample's z; empty if not applied
};

/// tuples: some thousand, spread over the image, their indices within z_um. z_um: measured z of the samples, at least
/// one. If a sixth of the curves already shows no gain, the figures use that subset. context: computes on the caller's
/// thread and on the pool.
[[nodiscard]] StageCorrection solve_stage_correction(std::span<const CurveTuple> tuples,
                                                     const std::vector<double>& z_um, WorkerPool& pool);

}  // namespace fvd
