#pragma once

/// The z of recorded slices, from a constant step or from a list.

#include <filesystem>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "drivers/replay/slice_files.hpp"

namespace fvd {

enum class LengthUnit { kMicrometre, kMillimetre, kMetre };

/// "um", "mm", "m".
[[nodiscard]] std::optional<LengthUnit> length_unit_from_name(std::string_view name) noexcept;

/// z = start_um + index * step_um; the step is negative for a stack recorded downwards.
struct ZSpacing {
  double start_um = 0.0;
  double step_um = 0.0;
};

/// A text file: one number per line in `unit`, decimal point; '#' starts a comment, empty lines are skipped.
struct ZFile {
  std::filesystem::path path;
  LengthUnit unit = LengthUnit::kMicrometre;
};

using ZSource = std::variant<ZSpacing, ZFile>;

/// z of each slice of the list in um, strictly rising or strictly falling.
/// Throws Error kBadInput: a step of 0, a step for a list whose numbering has a gap, a file that cannot be read, a line
/// that is not one number (named), another count than slices, z not finite or not monotonic, a file whose mean step is
/// below 0.001 um, which is one of another unit.
[[nodiscard]] std::vector<double> slice_heights_um(const ZSource& source, const SliceList& list);

/// Index of the height nearest to z_um; heights_um not empty.
[[nodiscard]] int nearest_slice(const std::vector<double>& heights_um, double z_um);

}  // namespace fvd
