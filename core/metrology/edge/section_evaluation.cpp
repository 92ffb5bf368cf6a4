#include "core/metrology/edge/section_evaluation.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/metrology/edge/flank_lines.hpp"
#include "core/metrology/edge/section_fit.hpp"
#include "core/metrology/edge/section_values.hpp"
#include "core/metrology/edge/tolerance.hpp"

namespace fvd::metrology::edge {
namespace {

// Sections of nearly one direction see the same window.
constexpr double kSameDirection = 2e-3;
// The window of what is not corrected: a pixel this small is none.
constexpr double kNoWindowUm = 1e-3;

void put(EdgeQuantity quantity, double value, EdgeSection& section) {
  section.values[static_cast<std::size_t>(quantity)] = value;
}

class Evaluator {
 public:
  Evaluator(const HeightField& field, const EdgeOptions& options)
      : field_(field), options_(options), none_(LateralKernel{}, kNoWindowUm, kNoWindowUm, 1.0, 0.0) {}

  EvaluatedSection run(const SectionData& data) {
    EvaluatedSection section;
    section.result.along_um = data.along_um;
    section.result.x_um = data.frame.x;
    section.result.y_um = data.frame.y;
    section.result.state = data.state;
    if (data.state != EdgeReason::kNone) return section;
    const auto lines = find_flank_lines(data, options_);
    if (!lines) {
      section.result.state = EdgeReason::kNotConverged;
      return section;
    }
    const bool good = options_.method == EdgeMethod::kTolerance ? by_tolerance(data, *lines, section)
                                                                : by_model(data, *lines, section);
    if (!good) {
      section.result.state = EdgeReason::kNotConverged;
      section.result.values = {};
      section.result.u = {};
      return section;
    }
    const SpacePoint apex = data.frame.at(section.apex_s_um, section.apex_h_um);
    section.result.x_um = apex.x;
    section.result.y_um = apex.y;
    return section;
  }

 private:
  bool by_model(const SectionData& data, const FlankLines& lines, EvaluatedSection& section) {
    const WindowProfile& window = window_of(data.frame);
    const SectionFit circle = fit_section(data, window, RoundingShape::kCircle, lines, options_);
    const SectionFit apparent = fit_section(data, none_, RoundingShape::kCircle, lines, options_);
    if (!circle.good || !apparent.good) return false;
    std::optional<SectionFit> conic;
    if (options_.method == EdgeMethod::kConic) {
      conic = fit_section(data, window, RoundingShape::kConic, lines, options_, &circle);
      if (!conic->good) return false;
    }
    const SectionFit& main = conic ? *conic : circle;
    section.apex_s_um = main.parameters[0];
    section.apex_h_um = main.parameters[1];
    std::vector<std::pair<EdgeQuantity, const SectionFit*>> figures;
    for (std::size_t q = 0; q < kEdgeQuantityCount; ++q) {
      const auto quantity = static_cast<EdgeQuantity>(q);
      if (quantity == EdgeQuantity::kResidualRms) continue;
      if (absent_by_method(quantity, options_.method) != EdgeReason::kNone) continue;
      const SectionFit* fit = quantity == EdgeQuantity::kRadius           ? &circle
                              : quantity == EdgeQuantity::kRadiusApparent ? &apparent
                                                                          : &main;
      put(quantity, figure_of(quantity, fit->model()), section.result);
      figures.emplace_back(quantity, fit);
    }
    put(EdgeQuantity::kResidualRms, main.residual_rms_um, section.result);
    add_noise(data, figures, section.result);
    return true;
  }

  bool by_tolerance(const SectionData& data, const FlankLines& lines, EvaluatedSection& section) const {
    const auto figures = measure_by_tolerance(data, lines, options_);
    const SectionFit apparent = fit_section(data, none_, RoundingShape::kCircle, lines, options_);
    if (!figures || !apparent.good) return false;
    section.apex_s_um = lines.apex_s_um;
    section.apex_h_um = lines.apex_h_um;
    put(EdgeQuantity::kBeta, figures->beta_deg, section.result);
    put(EdgeQuantity::kSGamma, figures->s_gamma_um, section.result);
    put(EdgeQuantity::kSAlpha, figures->s_alpha_um, section.result);
    // Where the contour never leaves the clearance's line there is no ratio.
    if (figures->s_alpha_um > 0.0) put(EdgeQuantity::kK, figures->s_gamma_um / figures->s_alpha_um, section.result);
    put(EdgeQuantity::kDeltaR, figures->delta_r_um, section.result);
    put(EdgeQuantity::kPhi, figures->phi_deg, section.result);
    put(EdgeQuantity::kRadiusApparent, figure_of(EdgeQuantity::kRadiusApparent, apparent.model()), section.result);
    add_noise(data, {{EdgeQuantity::kRadiusApparent, &apparent}}, section.result);
    return true;
  }

  void add_noise(const SectionData& data, const std::vector<std::pair<EdgeQuantity, const SectionFit*>>& figures,
                 EdgeSection& section) const {
    if (!field_.has_sigma()) return;
    Eigen::MatrixXd influences(static_cast<Eigen::Index>(data.s_um.size()), static_cast<Eigen::Index>(figures.size()));
    for (std::size_t i = 0; i < figures.size(); ++i) {
      influences.col(static_cast<Eigen::Index>(i)) = influence_on(figures[i].first, *figures[i].second);
    }
    const Eigen::VectorXd u = noise_of(influences, data, field_);
    for (std::size_t i = 0; i < figures.size(); ++i) {
      const EdgeQuantity quantity = figures[i].first;
      const auto q = static_cast<std::size_t>(quantity);
      section.u[q] = figure_noise(quantity, *section.values[q], u[static_cast<Eigen::Index>(i)]);
    }
  }

  const WindowProfile& window_of(const EdgeFrame& frame) {
    const double turn = std::abs(frame.u_x * window_u_[1] - frame.u_y * window_u_[0]);
    if (!window_ || turn > kSameDirection) {
      window_.emplace(field_.kernel, field_.pitch_x_um, field_.pitch_y_um, frame.u_x, frame.u_y);
      window_u_ = {frame.u_x, frame.u_y};
    }
    return *window_;
  }

  const HeightField& field_;
  const EdgeOptions& options_;
  WindowProfile none_;
  std::optional<WindowProfile> window_;
  std::array<double, 2> window_u_{};
};

}  // namespace

std::vector<EvaluatedSection> evaluate_sections(std::span<const SectionData> sections, const HeightField& field,
                                                const EdgeOptions& options) {
  Evaluator evaluator(field, options);
  std::vector<EvaluatedSection> evaluated;
  evaluated.reserve(sections.size());
  for (const SectionData& data : sections) evaluated.push_back(evaluator.run(data));
  return evaluated;
}

EdgeReason absent_by_method(EdgeQuantity quantity, EdgeMethod method) noexcept {
  switch (method) {
    case EdgeMethod::kConic:
      return EdgeReason::kNone;
    case EdgeMethod::kCircle:
      // They follow from the choice of the circle, not from the part.
      if (quantity == EdgeQuantity::kK || quantity == EdgeQuantity::kPhi) return EdgeReason::kNotDefinedByMethod;
      return EdgeReason::kNone;
    case EdgeMethod::kTolerance:
      if (quantity == EdgeQuantity::kRadius) return EdgeReason::kNotCorrected;
      if (quantity == EdgeQuantity::kRMin || quantity == EdgeQuantity::kResidualRms)
        return EdgeReason::kNotDefinedByMethod;
      return EdgeReason::kNone;
  }
  return EdgeReason::kNone;
}

}  // namespace fvd::metrology::edge
