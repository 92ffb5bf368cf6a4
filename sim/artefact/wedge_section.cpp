#include "sim/artefact/wedge_section.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "sim/artefact/plan.hpp"

namespace fvd::sim {

namespace {

SectionPoint times(double factor, const SectionPoint& p) { return {factor * p.s_um, factor * p.h_um}; }

double dot(const SectionPoint& p, const SectionPoint& q) { return p.s_um * q.s_um + p.h_um * q.h_um; }

double length(const SectionPoint& p) { return std::hypot(p.s_um, p.h_um); }

}  // namespace

WedgeSection::WedgeSection(const CuttingEdge& edge, double lean_deg) {
  const double half = radians(edge.beta_deg) / 2.0;
  const double lean = radians(lean_deg);
  rake_ = {-std::sin(half - lean), -std::cos(half - lean)};
  clearance_ = {std::sin(half + lean), -std::cos(half + lean)};
  assert(rake_.s_um < 0.0 && clearance_.s_um > 0.0);
  const bool conic = edge.rounding == Rounding::kConic;
  truth_.beta_deg = edge.beta_deg;
  truth_.weight = conic ? edge.weight.value_or(std::sin(half)) : std::sin(half);
  if (conic) {
    truth_.s_gamma_um = edge.s_gamma_um;
    truth_.s_alpha_um = edge.s_alpha_um;
  } else {
    truth_.radius_um = edge.rounding == Rounding::kCircle ? edge.radius_um : 0.0;
    truth_.s_gamma_um = truth_.s_alpha_um = *truth_.radius_um / std::tan(half);
  }
  p0_ = times(truth_.s_gamma_um, rake_);
  p2_ = times(truth_.s_alpha_um, clearance_);
  towards_nearest_ = {std::sin(lean), -std::cos(lean)};  // the bisector, for a sharp edge
  if (edge.rounding == Rounding::kSharp) return;
  truth_.k = truth_.s_gamma_um / truth_.s_alpha_um;
  find_nearest();
  // Into the body the line leans towards the clearance by as much as it leans towards the rake out of it.
  const SectionPoint bisector{std::sin(lean), -std::cos(lean)};
  const double towards_clearance = towards_nearest_.h_um * bisector.s_um - towards_nearest_.s_um * bisector.h_um;
  truth_.phi_deg = degrees(std::atan2(towards_clearance, dot(towards_nearest_, bisector))) + 0.0;  // no -0
}

SectionPoint WedgeSection::rounding(double t) const {
  const double a = 1.0 - t;
  const double divisor = a * a + 2.0 * truth_.weight * a * t + t * t;
  return {(a * a * p0_.s_um + t * t * p2_.s_um) / divisor, (a * a * p0_.h_um + t * t * p2_.h_um) / divisor};
}

/// With H = -w P0 a^2 + (P2 - P0) a b + w P2 b^2 the curve has p' = 2 H / D^2 and the curvature
/// w |P0 x P2| D^3 / (2 |H|^3).
double WedgeSection::curvature_radius_um(double t) const {
  const double a = 1.0 - t;
  const double w = truth_.weight;
  const double divisor = a * a + 2.0 * w * a * t + t * t;
  const auto part = [&](double p0, double p2) { return -w * p0 * a * a + (p2 - p0) * a * t + w * p2 * t * t; };
  const double slope = std::hypot(part(p0_.s_um, p2_.s_um), part(p0_.h_um, p2_.h_um));
  const double cross = std::abs(p0_.s_um * p2_.h_um - p0_.h_um * p2_.s_um);
  return 2.0 * slope * slope * slope / (w * cross * divisor * divisor * divisor);
}

/// The distance to a convex curve falls and then grows, so its derivative changes sign once. The least radius of a
/// conic's arc lies at an end or at a vertex; a fine search is enough for what is only told.
void WedgeSection::find_nearest() {
  const auto grows = [&](double t) {  // the sign of p . p'
    const double a = 1.0 - t;
    const double w = truth_.weight;
    const SectionPoint p = rounding(t);
    const SectionPoint tangent{-w * p0_.s_um * a * a + (p2_.s_um - p0_.s_um) * a * t + w * p2_.s_um * t * t,
                               -w * p0_.h_um * a * a + (p2_.h_um - p0_.h_um) * a * t + w * p2_.h_um * t * t};
    return dot(p, tangent) > 0.0;
  };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (grows(middle) ? high : low) = middle;
  }
  const SectionPoint nearest = rounding(0.5 * (low + high));
  truth_.delta_r_um = length(nearest);
  towards_nearest_ = times(1.0 / truth_.delta_r_um, nearest);
  constexpr int kSteps = 20000;
  truth_.r_min_um = curvature_radius_um(0.0);
  for (int i = 1; i <= kSteps; ++i) {
    truth_.r_min_um = std::min(truth_.r_min_um, curvature_radius_um(static_cast<double>(i) / kSteps));
  }
}

/// On the rounding q = b / a solves (P2s - s) q^2 - 2 w s q + (P0s - s) = 0, whose roots have opposite signs.
double WedgeSection::height_um(double s_um) const {
  if (s_um <= p0_.s_um) return s_um * rake_.h_um / rake_.s_um;
  if (s_um >= p2_.s_um) return s_um * clearance_.h_um / clearance_.s_um;
  const double w = truth_.weight;
  const double to_p0 = s_um - p0_.s_um;
  const double to_p2 = p2_.s_um - s_um;
  const double root = std::sqrt(w * w * s_um * s_um + to_p0 * to_p2);
  const double q = s_um < 0.0 ? to_p0 / (root - w * s_um) : (root + w * s_um) / to_p2;
  return (p0_.h_um + p2_.h_um * q * q) / (1.0 + 2.0 * w * q + q * q);
}

double WedgeSection::height_um(double s_um, double notch_um) const {
  const double contour = height_um(s_um);
  if (notch_um <= 0.0) return contour;
  const double floor = (truth_.delta_r_um + notch_um - s_um * towards_nearest_.s_um) / towards_nearest_.h_um;
  return std::min(contour, floor);
}

}  // namespace fvd::sim
