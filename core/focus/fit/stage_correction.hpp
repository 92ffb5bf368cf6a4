#pragma once

/// The stage's errors, seen in the focus curves themselves.
///
/// A slice whose z is wrong is wrong for every pixel alike: five samples of a curve lie on one parabola of G = -F^-1/2,
/// see five_sample_fit.hpp, and what is left over shows by how much each slice is off, in units of the parabola's slope
/// there. Thousands of curves whose peaks cover the range give one linear system for the offsets of all slices. What
/// grows with z or its square is taken out: a shift and a stretch leave no trace, and curves that lean look like the
/// rest. After G. Zhukova, C. Artigas, G. Carles, "Computational self-corrected quantitative 3D topographic imaging"
/// (the idea, for confocal stacks); here with five samples per pixel instead of the stack.
///
/// What curves of another shape leave over follows the fraction of a step and averages out only where peaks lie at all
/// fractions: so the system is solved only where they do, and used only where the offsets stand out of their error.

#include <span>
#include <string>
#include <vector>

#include "core/focus/fit/curve_tuple.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// Stage health as a scan shows it.
struct StageCorrection {
  bool applied = false;
  std::string reason;              ///< why not; empty where applied
  double rms_um = 0.0;             ///< of the offsets found, 0 where none were sought
  double standard_error_um = 0.0;  ///< of one offset
  std::vector<double> offsets_um;  ///< to be added to each sample's z; empty where not applied
};

/// z_um: measured z of the samples, at least one. Tuples: some thousand spread over the image, their indices within
/// z_um. If a sixth of the curves already shows no gain, the figures use that subset.
/// context: computes on the pool too.
[[nodiscard]] StageCorrection solve_stage_correction(std::span<const CurveTuple> tuples,
                                                     const std::vector<double>& z_um, WorkerPool& pool);

}  // namespace fvd
