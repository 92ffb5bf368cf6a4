#pragma once

/// Filters and evaluation area for texture that an instrument's pitch, window and field of view can hold.

#include <optional>
#include <string>
#include <vector>

#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// All > 0.
struct OpticalField {
  double pitch_x_um = 1.0;
  double pitch_y_um = 1.0;
  double window_px = 9.0;  ///< side of the focus window
  double width_um = 480.0;
  double height_um = 360.0;
};

/// A row of the default settings of ISO 21920-3:2021 for Ra, and whether a profile in this field can have it.
struct DefaultSettingsFit {
  std::optional<double> up_to_ra_um;  ///< absent = any above the row before
  double nesting_um = 0.0;
  double evaluation_length_um = 0.0;
  bool fits_along_x = false;
  bool fits_along_y = false;
  std::string problem;  ///< why it fits in neither direction

  [[nodiscard]] bool fits() const { return fits_along_x || fits_along_y; }
};

struct FilterSuggestion {
  double s_nesting_um = 0.0;
  std::optional<double> l_nesting_um;  ///< absent: the field is too small for any above S
  int areas = 0;                       ///< nesting indices of L along a side of the evaluation area
  PlannedRectangle area;               ///< square, in the middle of the field on whole pixels; without L all of it
  std::vector<DefaultSettingsFit> ra;
  std::vector<std::string> notes;  ///< what its user should know
};

/// S: the smallest of the series 1, 2, 2.5, 5, 8, 10 (ISO 25178-3:2012, nesting indices) that is 5 pixels and two focus
/// windows, below which the filter is refused or has nothing to do. L: the largest of the series of which five lie
/// along the shorter side, as the sections of a profile do; where that is not above S one that lies there once, the
/// least that ISO 25178-3 takes for an evaluation area. The area's side is a whole number of L. The choice of five is
/// an own definition. A row of default settings fits where its evaluation length lies along a side and its nesting
/// index has 5 pixels. context: pure.
[[nodiscard]] FilterSuggestion suggest_filters(const OpticalField& field);

/// A section "evaluation" as JSON text, ready for a recipe of format 2: surface, region and measurement of the
/// suggestion.
[[nodiscard]] std::string suggestion_json(const FilterSuggestion& suggestion);

/// For people: the choice, the table of default settings, the notes.
[[nodiscard]] std::string suggestion_text(const FilterSuggestion& suggestion);

}  // namespace fvd
