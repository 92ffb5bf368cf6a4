#pragma once

/// The order of slices, and their z, from their names.

#include <cstddef>
#include <string>
#include <vector>

namespace fvd {

struct NameOrder {
  std::vector<std::size_t> order;  ///< indices of the names given, in the order of the slices
  std::string description;         ///< e.g. "slice_*.png (31 files)"
  std::string gap;                 ///< why a constant step does not fit the numbers; empty: it does
  std::string doubt;               ///< where a slice may be missing; empty: nowhere
  std::vector<double> z_um;        ///< in that order; empty: the names carry no number with a unit
};

/// names: file names, at least two, whose stems have the same skeleton.
/// One number that varies gives the order; so does a number with a unit of length, which is z; a date with time; and of
/// several numbers that rise together any. A counter of four digits or more rolls over. Throws Error kBadInput with the
/// choices where the names allow more than one order, and for two names with the same number.
[[nodiscard]] NameOrder order_names(const std::vector<std::string>& names);

/// Why numbers in this order are not evenly spaced: "s2.png is followed by s4.png"; empty: they are. values: as many as
/// names; tolerance: rounding of a value.
[[nodiscard]] std::string uneven_spacing(const std::vector<double>& values, const std::vector<std::string>& names,
                                         double tolerance);

}  // namespace fvd
