#pragma once

/// One value over the sections of an edge.

#include <span>

#include "core/metrology/edge/edge_result.hpp"

namespace fvd::metrology::edge {

/// What neighbouring sections share of the points' noise: the variance of a mean over sections is this many times that
/// of as many independent ones. Noise along the edge is white, averaged over the window as a box, and over the section.
/// along_um: of the measured sections, multiples of every_um apart. At least 1. Own definition.
[[nodiscard]] double shared_noise(std::span<const double> along_um, double every_um, double window_um);

/// Median, percentiles and spread of the sections' values. u_noise: of each section, or empty where it is not known.
/// shared: of shared_noise. Standard errors are those of a median of normally distributed values, 1.2533 s / sqrt(n).
/// values: not empty; the reason of a missing u is set by the caller where the field has no sigma.
/// squares: for signed lengths, whose squares are what a section tells near nothing: spread and noise are those of
/// the squares v |v| about the median, and u of the length is sqrt(median^2 + u of the square) - |median|.
[[nodiscard]] EdgeValue summarise(std::span<const double> values, std::span<const double> u_noise, double shared,
                                  bool squares = false);

}  // namespace fvd::metrology::edge
