#pragma once

/// Scans of a plane by a confocal microscope, whose heights and Cramer-Rao bound are known.

namespace fvd::bench {

struct ConfocalFigures {
  double over_bound = 0.0;      ///< RMS error over the Cramer-Rao bound of an estimator that knows the curve
  double sigma_over_rms = 0.0;  ///< what the map says of its standard error, over what it is
  double valid = 0.0;           ///< share of the points that have a height
  double width_error = 0.0;     ///< the map's width of the curve over the true one, less 1
  int bin_slices = 1;
};

/// I(z) = sinc^2 with a full width at half maximum of 1 um above a background of 1.5 %, noise of 1 % of the peak,
/// slices step_widths apart over 3 widths on either side of a tilted plane; 16 bits, one pixel a window, bins as
/// choose_bin_slices() says.
[[nodiscard]] ConfocalFigures scan_confocal(double step_widths, unsigned seed = 1);

}  // namespace fvd::bench
