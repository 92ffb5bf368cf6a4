#pragma once

/// The model of a section fitted to its points.

#include <Eigen/Core>

#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/flank_lines.hpp"
#include "core/metrology/edge/section_data.hpp"
#include "core/metrology/edge/section_model.hpp"
#include "core/metrology/edge/window_profile.hpp"

namespace fvd::metrology::edge {

/// kCircle: tangent circle, five parameters. kConic: asymmetry and weight are free, seven parameters.
enum class RoundingShape { kCircle, kConic };

/// In the order apex_s, apex_h, rake, clearance, signed_square, log_k, log_weight less the circle's.
using ModelVector = Eigen::VectorXd;
[[nodiscard]] SectionModel model_of(const ModelVector& parameters);

struct SectionFit {
  bool good = false;  ///< a minimum inside of the section
  ModelVector parameters;
  Eigen::MatrixXd influence;     ///< [parameters][nodes]: d parameter / d height of a node
  double residual_rms_um = 0.0;  ///< of the nodes' orthogonal distances
  [[nodiscard]] SectionModel model() const { return model_of(parameters); }
};

/// Levenberg and Marquardt's method on distances at right angles to the model, weighted by sigma and by Huber's weights
/// (cut 1.345 robust standard deviations), with the correlation that the window gives to neighbours' errors taken out:
/// a sharp edge's radius then varies about 0.9 times as much. Asymmetry and weight of a conic are held by a weak prior,
/// ln K = 0 +- 1.5 and ln(weight / circle's) = 0 +- 0.75 at the noise of the flanks: without it they run away where the
/// rounding is as small as the window, and where it is large they do not feel it. start: from a fit of the circle; else
/// from the lines. Own definition.
[[nodiscard]] SectionFit fit_section(const SectionData& section, const WindowProfile& window, RoundingShape shape,
                                     const FlankLines& lines, const EdgeOptions& options,
                                     const SectionFit* start = nullptr);

}  // namespace fvd::metrology::edge
