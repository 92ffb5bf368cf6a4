#pragma once

/// The areal parameters: their names, units and values.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace fvd::metrology {

/// ISO 25178-2:2021. All heights are about the mean of the valid points; ratios are in percent of those points.
enum class ArealParameter {
  kSa,    ///< arithmetic mean height
  kSq,    ///< root mean square height
  kSsk,   ///< skewness
  kSku,   ///< kurtosis; 3 for heights of a normal distribution
  kSp,    ///< greatest peak height
  kSv,    ///< greatest pit depth, positive
  kSz,    ///< Sp + Sv
  kSdq,   ///< root mean square gradient
  kSdr,   ///< developed interfacial area ratio
  kSal,   ///< autocorrelation length
  kStr,   ///< texture aspect ratio
  kStd,   ///< texture direction
  kSmr,   ///< areal material ratio at a height
  kSmc,   ///< height at an areal material ratio
  kSxp,   ///< extreme peak height
  kSk,    ///< core height
  kSpk,   ///< reduced peak height
  kSvk,   ///< reduced pit depth
  kSmr1,  ///< material ratio of the hills; "Smrk1" is another name for it
  kSmr2,  ///< material ratio of the dales; "Smrk2" is another name for it
  kVmp,   ///< peak material volume for each area
  kVmc,   ///< core material volume for each area
  kVvc,   ///< core void volume for each area
  kVvv,   ///< pit void volume for each area
};

inline constexpr std::size_t kArealParameterCount = 24;

struct ArealParameterInfo {
  ArealParameter parameter;
  std::string_view name;        ///< "Sa"
  std::string_view key_suffix;  ///< "_um", "_percent", "_deg" or ""; name + suffix is the value's key
  std::string_view unit;        ///< "um", "%", "deg", "um3/um2" or ""
};

/// Every parameter once, in the order of the enumeration.
[[nodiscard]] std::span<const ArealParameterInfo, kArealParameterCount> areal_parameters();

[[nodiscard]] const ArealParameterInfo& areal_parameter_info(ArealParameter parameter);

/// name: as in the table, or one of the other names ("Smrk1", "Smrk2"). Absent for any other text.
[[nodiscard]] std::optional<ArealParameter> find_areal_parameter(std::string_view name);

/// A number, or the reason why there is none.
struct ArealValue {
  std::optional<double> value;  ///< in the parameter's unit
  std::string reason;           ///< one English sentence without a full stop; empty where there is a value
  bool tie = false;             ///< two equal candidates: two smallest secants, or two directions; the first was taken

  [[nodiscard]] static ArealValue of(double number, bool tie = false) { return {number, {}, tie}; }
  [[nodiscard]] static ArealValue none(std::string reason) { return {std::nullopt, std::move(reason), false}; }
};

}  // namespace fvd::metrology
