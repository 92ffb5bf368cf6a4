#pragma once

/// Nesting index and evaluation length that ISO 21920-3:2021 chooses where a drawing names none.

#include <span>
#include <string>
#include <string_view>

namespace fvd::metrology {

struct DefaultSettings {
  double up_to_ra_um;  ///< the row holds for tolerances up to this; the last: infinite
  double nesting_um;
  double evaluation_length_um;  ///< five sections of one nesting index
};

/// Five rows, finest first.
[[nodiscard]] std::span<const DefaultSettings> default_settings_table() noexcept;
/// The row for the upper tolerance of Ra. ra_um >= 0.
[[nodiscard]] const DefaultSettings& default_settings_for(double ra_um) noexcept;
/// Whether these are the row's, to 1e-6 of each.
[[nodiscard]] bool are_default_settings(const DefaultSettings& row, double nesting_um, double evaluation_length_um,
                                        int sections) noexcept;
/// "Ra" where they are, else e.g. "Ra (0.08 mm x 5)": section length and number.
[[nodiscard]] std::string label_with_settings(std::string_view name, bool is_default, double section_length_um,
                                              int sections);

}  // namespace fvd::metrology
