#pragma once

/// The z of recorded slices, from a constant step, a list or their names.

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

/// A text file in UTF-8, or UTF-16 with a byte order mark: one number per line in `unit`, with a sign or without; '#'
/// starts a comment, empty lines are skipped, the first line may be a header. A decimal comma is understood where it
/// cannot separate thousands.
struct ZFile {
  std::filesystem::path path;
  LengthUnit unit = LengthUnit::kMicrometre;
};

/// As the names of the slices say.
struct ZNames {};

using ZSource = std::variant<ZSpacing, ZFile, ZNames>;

/// z of each slice of the list in um, strictly rising or strictly falling.
/// Throws Error kBadInput: a step of 0, a step for a list whose numbering has a gap, a file that cannot be read, a line
/// that is not one number (named), a header of another unit, another count than slices, z not finite or not monotonic
/// or in another order than the z in the names, a mean step below 0.001 um, which is one of another unit, names
/// without z.
[[nodiscard]] std::vector<double> slice_heights_um(const ZSource& source, const SliceList& list);

/// Index of the height nearest to z_um; heights_um not empty.
[[nodiscard]] int nearest_slice(const std::vector<double>& heights_um, double z_um);

}  // namespace fvd
