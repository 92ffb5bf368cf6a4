#include "core/metrology/profile/profile_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <utility>

#include "core/base/error.hpp"
#include "core/metrology/filter/profile_filter.hpp"
#include "core/metrology/profile/default_settings.hpp"
#include "core/metrology/profile/profile_elements.hpp"
#include "core/metrology/profile/profile_heights.hpp"
#include "core/metrology/profile/profile_material_ratio.hpp"

namespace fvd::metrology {
namespace {

/// Own definition: below, one point is more than 1 % of the material ratio.
constexpr std::size_t kMinMaterialPoints = 100;

std::string text_of(const char* format, double a, double b) {
  char text[128];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

struct Refusal {
  ProfileReason reason = ProfileReason::kNone;
  std::string detail;
};

/// One of P, W and R over the evaluation length.
struct Surface {
  std::vector<double> z_um;
  Refusal refusal;  ///< kNone, or why none of its values is given
  HeightSums sums;
  std::vector<HeightSums> sections;
};

class Evaluation {
 public:
  Evaluation(const Profile& profile, std::span<const ProfileParameter> parameters, const ProfileSettings& settings)
      : profile_(profile), settings_(settings) {
    set_lengths();
    set_p();
    const bool filtered = std::any_of(parameters.begin(), parameters.end(), [](ProfileParameter parameter) {
      return profile_parameter_info(parameter).kind != ProfileKind::kP;
    });
    if (filtered) set_w_and_r();
    set_validity(filtered ? r_ : p_);
    if (filtered) set_default_settings();
    for (const ProfileParameter parameter : parameters) result_.values.push_back(value(parameter));
  }

  [[nodiscard]] ProfileResult take() { return std::move(result_); }

 private:
  void set_lengths();
  void set_p();
  void set_w_and_r();
  void set_validity(const Surface& surface);
  void set_default_settings();
  [[nodiscard]] Surface part(std::span<const double> z_um) const;
  void judge(Surface& surface) const;
  [[nodiscard]] ProfileValue value(ProfileParameter parameter);
  void set_height_value(const Surface& surface, ProfileValue& value) const;
  void set_shape_value(const Surface& surface, ProfileValue& value) const;
  void set_section_value(ProfileValue& value) const;
  void set_element_value(ProfileValue& value);
  void set_material_value(ProfileValue& value) const;

  const Profile& profile_;
  const ProfileSettings& settings_;
  ProfileResult result_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  Refusal too_short_;
  Surface p_;
  Surface w_;
  Surface r_;
};

void refuse(ProfileValue& value, ProfileReason reason, std::string detail) {
  value.value.reset();
  value.reason = reason;
  value.detail = std::move(detail);
}

void Evaluation::set_lengths() {
  result_.sections = settings_.sections;
  const double whole = profile_.length_um() / settings_.sections;
  result_.section_length_um =
      settings_.section_length_um.value_or(settings_.nesting_um > 0.0 ? settings_.nesting_um : whole);
  result_.evaluation_length_um = settings_.sections * result_.section_length_um;
  const double points = result_.evaluation_length_um / profile_.pitch_um;
  const auto all = static_cast<double>(profile_.z_um.size());
  if (points > all * (1.0 + 1e-9)) {
    too_short_ = {ProfileReason::kEvaluationLength,
                  text_of("the profile of %.6g um does not hold the evaluation length of %.6g um", profile_.length_um(),
                          result_.evaluation_length_um)};
  } else if (points < settings_.sections) {
    too_short_ = {ProfileReason::kTooFewPoints, "a section holds no point"};
  } else {
    // The same whole number of points on both sides, so that a mirrored profile gives the same.
    first_ = static_cast<std::size_t>(std::max(0.5 * (all - points) + 1e-6, 0.0));
    count_ = profile_.z_um.size() - 2 * first_;
  }
}

Surface Evaluation::part(std::span<const double> z_um) const {
  const auto middle = z_um.subspan(first_, count_);
  return {{middle.begin(), middle.end()}, too_short_, {}, {}};
}

void Evaluation::judge(Surface& surface) const {
  const std::span<const double> z = surface.z_um;
  surface.sums = sum_heights(z);
  const auto sections = static_cast<std::size_t>(settings_.sections);
  for (std::size_t k = 0; k < sections; ++k) {
    // Points stand in the middle of their pitch; one that stands between two sections belongs to both.
    const std::size_t from = k == 0 ? 0 : (2 * k * count_ + sections - 1) / (2 * sections);
    const std::size_t end = ((2 * k + 2) * count_ + sections) / (2 * sections);
    surface.sections.push_back(sum_heights(z.subspan(from, end - from)));
  }
  if (surface.refusal.reason != ProfileReason::kNone) return;
  const double longest_um = static_cast<double>(longest_hole(z)) * profile_.pitch_um;
  const double allowed_um = 0.25 * (settings_.nesting_um > 0.0 ? settings_.nesting_um : result_.section_length_um);
  if (longest_um > allowed_um * (1.0 + 1e-9)) {
    surface.refusal = {
        ProfileReason::kHoleTooLong,
        text_of("a hole of %.6g um is longer than %.6g um, a quarter of the nesting index", longest_um, allowed_um)};
  } else if (std::any_of(surface.sections.begin(), surface.sections.end(),
                         [](const HeightSums& sums) { return sums.points == 0; })) {
    surface.refusal = {ProfileReason::kSectionEmpty, "a section has no valid point"};
  }
}

void Evaluation::set_p() {
  p_ = part(profile_.z_um);
  p_.z_um = less_line(p_.z_um);
  judge(p_);
}

void Evaluation::set_w_and_r() {
  std::vector<double> rest;
  Refusal refusal = too_short_;
  try {
    FilteredProfile filtered = filter_profile(profile_.z_um, profile_.pitch_um,
                                              {.side = FilterSide::kL,
                                               .nesting_um = settings_.nesting_um,
                                               .method = settings_.method,
                                               .robust = settings_.robust,
                                               .keep_margin = false,
                                               .noise_floor_um = settings_.noise_floor_um});
    rest = std::move(filtered.z_um);
    result_.filter = filtered.report;
    const double left_um = profile_.length_um() - 2.0 * filtered.report.margin_um;
    if (refusal.reason == ProfileReason::kNone && result_.evaluation_length_um > left_um * (1.0 + 1e-9)) {
      refusal = {ProfileReason::kEvaluationLength,
                 text_of("the filter leaves %.6g um, the evaluation length is %.6g um", left_um,
                         result_.evaluation_length_um)};
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadInput) throw;
    refusal = {ProfileReason::kFilter, error.what()};
    rest.assign(profile_.z_um.size(), std::nan(""));
  }
  std::vector<double> smooth = profile_.z_um;
  for (std::size_t i = 0; i < smooth.size(); ++i) smooth[i] -= rest[i];
  r_ = part(rest);
  r_.refusal = refusal;
  judge(r_);
  w_ = part(smooth);
  w_.refusal = refusal;
  w_.z_um = less_mean(w_.z_um);
  judge(w_);
}

void Evaluation::set_validity(const Surface& surface) {
  result_.points = surface.sums.points;
  result_.valid_fraction = count_ == 0 ? 0.0 : static_cast<double>(result_.points) / static_cast<double>(count_);
  result_.longest_hole_um = static_cast<double>(longest_hole(surface.z_um)) * profile_.pitch_um;
}

void Evaluation::set_default_settings() {
  std::optional<double> ra_um = settings_.tolerance_ra_um;
  if (!ra_um && r_.refusal.reason == ProfileReason::kNone) ra_um = r_.sums.mean_absolute_um;
  if (ra_um) {
    const bool usual_filter = !settings_.robust && settings_.method != FilterMethod::kGaussianRegression2;
    result_.default_settings = usual_filter && are_default_settings(default_settings_for(*ra_um), settings_.nesting_um,
                                                                    result_.evaluation_length_um, settings_.sections);
  }
  result_.label_suffix =
      label_with_settings("", result_.default_settings.value_or(false), result_.section_length_um, settings_.sections);
}

ProfileValue Evaluation::value(ProfileParameter parameter) {
  ProfileValue value{parameter, {}, ProfileReason::kNone, {}, false};
  const ProfileKind kind = profile_parameter_info(parameter).kind;
  const Surface& surface = kind == ProfileKind::kP ? p_ : (kind == ProfileKind::kW ? w_ : r_);
  if (surface.refusal.reason != ProfileReason::kNone) {
    refuse(value, surface.refusal.reason, surface.refusal.detail);
    return value;
  }
  using enum ProfileParameter;
  switch (parameter) {
    case kPa:
    case kPq:
    case kPz:
    case kPt:
    case kWa:
    case kWq:
    case kWt:
    case kRa:
    case kRq:
    case kRt:
      set_height_value(surface, value);
      break;
    case kPsk:
    case kPku:
    case kRsk:
    case kRku:
      set_shape_value(surface, value);
      break;
    case kRz:
    case kRp:
    case kRv:
      set_section_value(value);
      break;
    case kRSm:
    case kRc:
      set_element_value(value);
      break;
    case kRdq:
      value.value = root_mean_square_slope(r_.z_um, profile_.pitch_um);
      if (!value.value) refuse(value, ProfileReason::kTooFewPoints, "no point has neighbours on both sides");
      break;
    case kRk:
    case kRpk:
    case kRvk:
    case kRmr1:
    case kRmr2:
      set_material_value(value);
      break;
  }
  return value;
}

void Evaluation::set_height_value(const Surface& surface, ProfileValue& value) const {
  using enum ProfileParameter;
  const ProfileParameter parameter = value.parameter;
  if (parameter == kPa || parameter == kWa || parameter == kRa) {
    value.value = surface.sums.mean_absolute_um;
  } else if (parameter == kPq || parameter == kWq || parameter == kRq) {
    value.value = surface.sums.root_mean_square_um;
  } else {
    value.value = surface.sums.highest_um + surface.sums.deepest_um;
  }
}

void Evaluation::set_shape_value(const Surface& surface, ProfileValue& value) const {
  const double rms_um = surface.sums.root_mean_square_um;
  if (rms_um <= 0.0) {
    refuse(value, ProfileReason::kFlat, "the profile is flat");
  } else if (settings_.noise_floor_um && rms_um <= *settings_.noise_floor_um) {
    refuse(value, ProfileReason::kBelowNoise,
           text_of("the root mean square of %.6g um is not above the noise floor of %.6g um", rms_um,
                   *settings_.noise_floor_um));
  } else {
    const bool skewness = value.parameter == ProfileParameter::kPsk || value.parameter == ProfileParameter::kRsk;
    value.value = skewness ? surface.sums.cubes : surface.sums.fourths;
  }
}

void Evaluation::set_section_value(ProfileValue& value) const {
  double sum = 0.0;
  for (const HeightSums& section : r_.sections) {
    if (value.parameter != ProfileParameter::kRv) sum += section.highest_um;
    if (value.parameter != ProfileParameter::kRp) sum += section.deepest_um;
  }
  value.value = sum / static_cast<double>(r_.sections.size());
}

void Evaluation::set_element_value(ProfileValue& value) {
  double hills_um = 0.0;
  double dales_um = 0.0;
  for (const HeightSums& section : r_.sections) {
    hills_um += section.highest_um;
    dales_um += section.deepest_um;
  }
  const double share = settings_.height_discrimination / static_cast<double>(r_.sections.size());
  const ElementDiscrimination least{std::max(share * hills_um, 0.0), std::max(share * dales_um, 0.0),
                                    settings_.length_discrimination * result_.section_length_um};
  result_.height_discrimination_hill_um = least.hill_um;
  result_.height_discrimination_dale_um = least.dale_um;
  result_.length_discrimination_um = least.length_um;
  const ProfileElements elements = find_profile_elements(r_.z_um, profile_.pitch_um, least);
  value.value = value.parameter == ProfileParameter::kRSm ? elements.mean_length_um : elements.mean_height_um;
  if (value.value) return;
  if (elements.crossings == 0) {
    refuse(value, ProfileReason::kNoCrossing, "the profile does not cross its reference line");
  } else {
    refuse(value, ProfileReason::kNoElement, "no hill with its dale is complete");
  }
}

void Evaluation::set_material_value(ProfileValue& value) const {
  std::vector<double> sorted;
  std::copy_if(r_.z_um.begin(), r_.z_um.end(), std::back_inserter(sorted), [](double z) { return !std::isnan(z); });
  if (sorted.size() < kMinMaterialPoints) {
    refuse(value, ProfileReason::kTooFewPoints,
           text_of("%.0f points, a material ratio curve needs %.0f", static_cast<double>(sorted.size()),
                   static_cast<double>(kMinMaterialPoints)));
    return;
  }
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  const MaterialRatioCore core = material_ratio_core(sorted);
  value.tie = core.tie;
  using enum ProfileParameter;
  if (value.parameter == kRk) value.value = core.core_um;
  if (value.parameter == kRpk) value.value = core.peaks_um;
  if (value.parameter == kRvk) value.value = core.valleys_um;
  if (value.parameter == kRmr1) value.value = core.upper_percent;
  if (value.parameter == kRmr2) value.value = core.lower_percent;
}

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

ProfileResult evaluate_profile(const Profile& profile, std::span<const ProfileParameter> parameters,
                               const ProfileSettings& settings) {
  if (profile.z_um.empty()) throw Error(ErrorCode::kBadInput, "profile: it has no point");
  const bool lengths = is_positive(profile.pitch_um) && std::isfinite(settings.nesting_um) &&
                       settings.nesting_um >= 0.0 && is_positive(settings.section_length_um.value_or(1.0));
  if (!lengths) {
    throw Error(ErrorCode::kBadInput, "profile: pitch, nesting index and section length must be positive numbers");
  }
  if (settings.sections < 1) throw Error(ErrorCode::kBadInput, "profile: at least one section is needed");
  return Evaluation(profile, parameters, settings).take();
}

}  // namespace fvd::metrology
