#pragma once

/// Hills and dales of a profile by the crossing-the-line segmentation, for RSm and Rc.

#include <cstddef>
#include <optional>
#include <span>

namespace fvd::metrology {

struct ElementDiscrimination {
  double hill_um = 0.0;    ///< a hill that stays below does not count
  double dale_um = 0.0;    ///< a dale whose depth stays below does not count
  double length_um = 0.0;  ///< a hill or dale that is shorter does not count
};

struct ProfileElements {
  std::size_t crossings = 0;             ///< between hills and dales that count
  std::size_t elements = 0;              ///< complete ones
  std::optional<double> mean_length_um;  ///< RSm; absent without an element
  std::optional<double> mean_height_um;  ///< Rc: from the dale's lowest to the hill's highest point
};

/// An element is a hill and the dale next to it, both complete, that is from one crossing to the one after the next;
/// as ISO 21920-2 evaluates in both directions, every such pair counts, whichever comes first, and a mirrored profile
/// gives the same. Hills and dales that do not count are joined with what lies on both sides; where several crossings
/// lie between a hill and a dale that count, the crossing is the middle of the first and the last. Crossings are found
/// by straight lines between neighbouring points; a hole ends the profile and the next point begins another.
/// ISO 21920-2:2021 (crossing-the-line segmentation); the joining is an own definition. context: pure.
[[nodiscard]] ProfileElements find_profile_elements(std::span<const double> z_um, double pitch_um,
                                                    const ElementDiscrimination& discrimination);

}  // namespace fvd::metrology
