#include "daemon/evaluation/filter_suggestion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/metrology/profile/default_settings.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

constexpr double kLeastPixels = 5.0;   ///< of a sampled Gaussian kernel that is right to 2e-5
constexpr double kLeastWindows = 2.0;  ///< shorter wavelengths are gone already
constexpr int kWantedAreas = 5;
constexpr std::array kSeries{1.0, 2.0, 2.5, 5.0, 8.0};
constexpr int kLeastDecade = -2;
constexpr int kMostDecade = 6;
constexpr double kSlack = 1e-9;  ///< of a length that divides up to rounding

std::vector<double> series_um() {
  std::vector<double> values;
  for (int decade = kLeastDecade; decade <= kMostDecade; ++decade) {
    for (const double digit : kSeries) values.push_back(digit * std::pow(10.0, decade));
  }
  return values;
}

double at_least(double least_um) {
  const std::vector<double> series = series_um();
  const auto found = std::lower_bound(series.begin(), series.end(), least_um * (1.0 - kSlack));
  return found == series.end() ? least_um : *found;
}

/// Nothing where the smallest of the series is above.
std::optional<double> at_most(double most_um) {
  const std::vector<double> series = series_um();
  const auto above = std::upper_bound(series.begin(), series.end(), most_um * (1.0 + kSlack));
  return above == series.begin() ? std::nullopt : std::optional(*(above - 1));
}

std::string um_text(double um) {
  std::ostringstream text;
  text << um << " um";
  return text.str();
}

DefaultSettingsFit fit_of(const metrology::DefaultSettings& row, const OpticalField& field) {
  DefaultSettingsFit fit;
  if (std::isfinite(row.up_to_ra_um)) fit.up_to_ra_um = row.up_to_ra_um;
  fit.nesting_um = row.nesting_um;
  fit.evaluation_length_um = row.evaluation_length_um;
  const auto fits = [&row](double side_um, double pitch_um) {
    return row.evaluation_length_um <= side_um * (1.0 + kSlack) &&
           row.nesting_um >= kLeastPixels * pitch_um * (1.0 - kSlack);
  };
  fit.fits_along_x = fits(field.width_um, field.pitch_x_um);
  fit.fits_along_y = fits(field.height_um, field.pitch_y_um);
  if (fit.fits()) return fit;
  const double longest_um = std::max(field.width_um, field.height_um);
  fit.problem = row.evaluation_length_um > longest_um ? "the field is " + um_text(longest_um) + " long"
                                                      : "the nesting index has less than 5 pixels";
  return fit;
}

/// The square in the middle, its corner on a pixel's.
PlannedRectangle middle_square(double side_um, const OpticalField& field) {
  const auto begin = [side_um](double field_um, double pitch_um) {
    return pitch_um * std::floor((field_um - side_um) / 2.0 / pitch_um + kSlack);
  };
  return {begin(field.width_um, field.pitch_x_um), begin(field.height_um, field.pitch_y_um), side_um, side_um};
}

void choose_l(const OpticalField& field, FilterSuggestion& made) {
  const double side_um = std::min(field.width_um, field.height_um);
  std::optional<double> l_um = at_most(side_um / kWantedAreas);
  if (!l_um || *l_um <= made.s_nesting_um) l_um = at_most(side_um);
  if (!l_um || *l_um <= made.s_nesting_um) {
    made.area = {0.0, 0.0, field.width_um, field.height_um};
    made.notes.push_back("no L filter: the field's shorter side of " + um_text(side_um) +
                         " holds none above the S filter's " + um_text(made.s_nesting_um) +
                         "; take a smaller window, or a larger field");
    return;
  }
  made.l_nesting_um = l_um;
  made.areas = static_cast<int>(std::floor(side_um / *l_um * (1.0 + kSlack)));
  made.area = middle_square(made.areas * *l_um, field);
  if (made.areas < kWantedAreas) {
    made.notes.push_back("the evaluation area holds the L filter's nesting index " + std::to_string(made.areas) +
                         " time(s) along a side, where five are usual: its parameters scatter from place to place");
  }
}

}  // namespace

FilterSuggestion suggest_filters(const OpticalField& field) {
  FilterSuggestion made;
  const double window_um = field.window_px * std::max(field.pitch_x_um, field.pitch_y_um);
  const double least_um =
      std::max(kLeastPixels * std::max(field.pitch_x_um, field.pitch_y_um), kLeastWindows * window_um);
  made.s_nesting_um = at_least(least_um);
  choose_l(field, made);
  for (const metrology::DefaultSettings& row : metrology::default_settings_table()) {
    made.ra.push_back(fit_of(row, field));
  }
  made.notes.push_back("wavelengths below two focus windows, " + um_text(kLeastWindows * window_um) +
                       ", are not measured in full, whatever the S filter");
  const bool any = std::any_of(made.ra.begin(), made.ra.end(), [](const auto& row) { return row.fits(); });
  made.notes.emplace_back(
      any ? "Ra of a class that does not fit is measured with other settings and told with them, e.g. "
            "\"Ra (0.08 mm x 5)\""
          : "no class of default settings fits: every Ra is told with its own settings");
  return made;
}

std::string suggestion_json(const FilterSuggestion& suggestion) {
  const PlannedRectangle& area = suggestion.area;
  ordered_json steps =
      ordered_json::array({{{"op", "form"}, {"form", "polynomial"}, {"degree", 2}},
                           {{"op", "filter"}, {"side", "S"}, {"nesting_um", suggestion.s_nesting_um}}});
  if (suggestion.l_nesting_um) {
    // The local paraboloid keeps the field up to its border.
    steps.push_back({{"op", "filter"},
                     {"side", "L"},
                     {"nesting_um", *suggestion.l_nesting_um},
                     {"method", "gaussian_regression_2"}});
  }
  const ordered_json evaluation{
      {"surfaces", {{"texture", {{"from", "measured"}, {"steps", std::move(steps)}}}}},
      {"regions",
       {{"area",
         {{"rectangle_um",
           {{"x", area.x_um}, {"y", area.y_um}, {"width", area.width_um}, {"height", area.height_um}}}}}}},
      {"measurements",
       {{"texture",
         {{"kind", "areal"},
          {"surface", "texture"},
          {"region", "area"},
          {"parameters", {"Sa", "Sq", "Sz", "Sdq", "Sdr"}}}}}}};
  return ordered_json{{"evaluation", evaluation}}.dump(2) + "\n";
}

std::string suggestion_text(const FilterSuggestion& suggestion) {
  constexpr int kColumn = 16;
  const PlannedRectangle& area = suggestion.area;
  std::ostringstream text;
  text << "S filter    " << um_text(suggestion.s_nesting_um) << "\n";
  text << "L filter    " << (suggestion.l_nesting_um ? um_text(*suggestion.l_nesting_um) : "none") << "\n";
  text << "area        " << area.width_um << " x " << area.height_um << " um at " << area.x_um << ", " << area.y_um
       << " um\n\n";
  text << "default settings of ISO 21920-3 for Ra\n" << std::left;
  const auto row = [&text](std::string_view ra, std::string_view nesting, std::string_view length,
                           std::string_view fits) {
    text << "  " << std::setw(kColumn) << ra << std::setw(kColumn) << nesting << std::setw(kColumn + 6) << length
         << fits << "\n";
  };
  row("tolerance", "nesting index", "evaluation length", "fits");
  double before_um = 0.0;
  for (const DefaultSettingsFit& fit : suggestion.ra) {
    const std::string ra = fit.up_to_ra_um ? "to " + um_text(*fit.up_to_ra_um) : "above " + um_text(before_um);
    const std::string fits = !fit.fits()                            ? "no: " + fit.problem
                             : fit.fits_along_x && fit.fits_along_y ? "yes"
                             : fit.fits_along_x                     ? "along x"
                                                                    : "along y";
    row(ra, um_text(fit.nesting_um), um_text(fit.evaluation_length_um), fits);
    before_um = fit.up_to_ra_um.value_or(before_um);
  }
  text << "\n";
  for (const std::string& note : suggestion.notes) text << "note: " << note << "\n";
  return text.str();
}

}  // namespace fvd
