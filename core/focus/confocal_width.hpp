#pragma once

/// How wide the curve of a confocal microscope is along the optical axis.

namespace fvd {

/// The full width at half maximum, in um, of I(z) = |int_0^alpha sin t e^(2ikz cos t) dt|^2 of a mirror, a pinhole and
/// a source that are points: sinc^2 of k z (n - sqrt(n^2 - NA^2)), half of which is reached at 0.443 lambda over that
/// difference (Corle and Kino, Confocal scanning optical microscopy and related imaging systems, 1996, section 3.2).
/// An objective after the sine condition has a curve wider by 1 % (NA 0.8) to 6 % (0.95); a pinhole of a radius of 2, 3
/// and 4 optical units one wider by 1.5, 9 and 35 %.
/// na: above 0 and below index. wavelength_um: in vacuum, > 0. index: of what is between lens and surface, >= 1. Throws
/// Error kBadInput.
[[nodiscard]] double confocal_width_um(double na, double wavelength_um, double index = 1.0);

}  // namespace fvd
