#pragma once

/// What a fitted section says about the edge.

#include <Eigen/Core>

#include "core/metrology/edge/edge_result.hpp"
#include "core/metrology/edge/section_data.hpp"
#include "core/metrology/edge/section_fit.hpp"

namespace fvd::metrology::edge {

/// The quantity of this model; kRadius and kRadiusApparent are the radius of a circle's model. quantity: not
/// kResidualRms. A rounding below nothing (noise added material) has negative lengths.
[[nodiscard]] double figure_of(EdgeQuantity quantity, const SectionModel& model);

/// d figure / d height of each node of the section: row of Jacobian times influence. For lengths it is that of L |L|,
/// which is smooth through nothing: see figure_noise.
[[nodiscard]] Eigen::VectorXd influence_on(EdgeQuantity quantity, const SectionFit& fit);

/// Standard uncertainties of sums over nodes of influences(node, n) x height, for each column n: the points' sigma, and
/// errors that neighbours share through the kernel k: var = sum_p (sum_i k(p - i) w_i sigma_i)^2 / sum k^2 (own
/// definition, as for linear estimates). The field must have sigma.
[[nodiscard]] Eigen::VectorXd noise_of(const Eigen::MatrixXd& influences, const SectionData& section,
                                       const HeightField& field);

/// u of a figure from what noise_of makes of influence_on: for lengths sqrt(L^2 + u of the square) - |L|.
[[nodiscard]] double figure_noise(EdgeQuantity quantity, double figure, double u);

/// Whether it is a length of the rounding.
[[nodiscard]] bool is_length(EdgeQuantity quantity) noexcept;

}  // namespace fvd::metrology::edge
