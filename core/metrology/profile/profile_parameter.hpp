#pragma once

/// The parameters of profiles by ISO 21920-2:2021, their names and units.

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fvd::metrology {

enum class ProfileParameter {
  kPa,
  kPq,
  kPz,
  kPt,
  kPsk,
  kPku,  // the profile less its least squares line
  kWa,
  kWq,
  kWt,  // the smooth profile of the filter
  kRa,
  kRq,
  kRsk,
  kRku,
  kRt,
  kRz,
  kRp,
  kRv,
  kRSm,
  kRc,
  kRdq,  // the rest of the filter
  kRk,
  kRpk,
  kRvk,
  kRmr1,
  kRmr2,  // and its material ratio curve
};

enum class ProfileKind { kP, kW, kR };

struct ProfileParameterInfo {
  ProfileParameter parameter;
  std::string_view name;    ///< "Ra"
  std::string_view suffix;  ///< of the key: "_um", "_percent" or ""
  ProfileKind kind;
};

/// In the order of the enumeration.
[[nodiscard]] std::span<const ProfileParameterInfo> profile_parameters() noexcept;
[[nodiscard]] const ProfileParameterInfo& profile_parameter_info(ProfileParameter parameter) noexcept;
[[nodiscard]] std::optional<ProfileParameter> profile_parameter_from_name(std::string_view name) noexcept;

/// Why a value is not given.
enum class ProfileReason {
  kNone,              ///< it is
  kFilter,            ///< no nesting index is given, or it is under 5 points
  kEvaluationLength,  ///< the profile does not hold the evaluation length
  kHoleTooLong,       ///< a section has a hole longer than a quarter of the nesting index
  kSectionEmpty,      ///< a section without a valid point
  kBelowNoise,        ///< Rq does not exceed the noise floor: the shape would be that of the noise
  kFlat,              ///< Rq is 0
  kNoCrossing,        ///< the profile crosses its reference line nowhere
  kNoElement,         ///< no hill with its dale stands complete between two holes or ends
  kTooFewPoints,      ///< for a slope, or a material ratio curve
};
/// The stable name, e.g. "no_crossing"; "" for kNone.
[[nodiscard]] std::string_view profile_reason_name(ProfileReason reason) noexcept;

struct ProfileValue {
  ProfileParameter parameter = ProfileParameter::kRa;
  std::optional<double> value;  ///< in the unit of its suffix; absent with a reason
  ProfileReason reason = ProfileReason::kNone;
  std::string detail;  ///< a sentence with the figures, for people; empty for a value
  bool tie = false;    ///< Rk family: several smallest secants, the first from the left was taken
};

}  // namespace fvd::metrology
