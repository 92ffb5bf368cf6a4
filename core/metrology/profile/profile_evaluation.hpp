#pragma once

/// Parameters of a profile by ISO 21920-2:2021.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/metrology/filter/filter_settings.hpp"
#include "core/metrology/profile/profile.hpp"
#include "core/metrology/profile/profile_parameter.hpp"

namespace fvd::metrology {

struct ProfileSettings {
  double nesting_um = 0.0;  ///< of the filter between W and R (lambda c); P needs it for the rule of holes alone
  /// The local line is inside what the Gaussian of ISO 16610-21 is, and keeps its moments at the ends (ISO 16610-28);
  /// kGaussian takes nesting_um / 2 away at each end.
  FilterMethod method = FilterMethod::kGaussianRegression1;
  bool robust = false;
  int sections = 5;  ///< >= 1
  /// Absent: nesting_um, and without that the whole profile in equal sections.
  std::optional<double> section_length_um = std::nullopt;
  std::optional<double> tolerance_ra_um = std::nullopt;  ///< chooses the default settings; absent: the measured Ra does
  std::optional<double> noise_floor_um =
      std::nullopt;                     ///< Rsk and Rku are not given where Rq is not above it; likewise Psk, Pku
  double height_discrimination = 0.1;   ///< of Rp for hills and of Rv for dales: lower ones do not count (RSm, Rc)
  double length_discrimination = 0.01;  ///< of the section length: shorter hills and dales do not count
};

struct ProfileResult {
  std::vector<ProfileValue> values;   ///< in the order they were asked for
  std::size_t points = 0;             ///< valid points inside the evaluation length
  double valid_fraction = 0.0;        ///< of its points
  double longest_hole_um = 0.0;       ///< inside it
  double evaluation_length_um = 0.0;  ///< sections * section_length_um; in the middle, ends at whole points
  double section_length_um = 0.0;
  int sections = 0;
  std::optional<bool> default_settings;  ///< absent: neither a tolerance nor an Ra
  std::string label_suffix;              ///< "" or " (0.08 mm x 5)": what a name is printed with, not for P
  std::optional<double> height_discrimination_hill_um;  ///< applied by RSm and Rc
  std::optional<double> height_discrimination_dale_um;
  std::optional<double> length_discrimination_um;
  std::optional<FilterReport> filter;  ///< absent where nothing asked for needs one, or it was refused
};

/// Formulas: ISO 21920-2:2021, heights against the reference line (P: least squares line over the evaluation length;
/// W: its mean; R: the filter's). Pa Pq Psk Pku Pt Pz, Wa Wq Wt, Ra Rq Rsk Rku Rt Rdq and the Rk family over the
/// evaluation length (P has one section, so that Pz = Pt); Rz Rp Rv means over the sections; RSm Rc over complete
/// elements, see profile_elements.hpp. A point belongs to the section in which it stands, to both on their common end.
///
/// No value is given where a section has a hole longer than nesting_um / 4 (without one: section / 4); one that cannot
/// be given says why. Throws Error(kBadInput) for an empty profile, sections < 1, lengths that are not positive
/// numbers. context: pure.
[[nodiscard]] ProfileResult evaluate_profile(const Profile& profile, std::span<const ProfileParameter> parameters,
                                             const ProfileSettings& settings);

}  // namespace fvd::metrology
