#include "core/metrology/profile/profile_parameter.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace fvd::metrology {
namespace {

using enum ProfileParameter;
using enum ProfileKind;

constexpr std::array<ProfileParameterInfo, 25> kInfos{{
    {kPa, "Pa", "_um", kP},          {kPq, "Pq", "_um", kP},   {kPz, "Pz", "_um", kP},
    {kPt, "Pt", "_um", kP},          {kPsk, "Psk", "", kP},    {kPku, "Pku", "", kP},
    {kWa, "Wa", "_um", kW},          {kWq, "Wq", "_um", kW},   {kWt, "Wt", "_um", kW},
    {kRa, "Ra", "_um", kR},          {kRq, "Rq", "_um", kR},   {kRsk, "Rsk", "", kR},
    {kRku, "Rku", "", kR},           {kRt, "Rt", "_um", kR},   {kRz, "Rz", "_um", kR},
    {kRp, "Rp", "_um", kR},          {kRv, "Rv", "_um", kR},   {kRSm, "RSm", "_um", kR},
    {kRc, "Rc", "_um", kR},          {kRdq, "Rdq", "", kR},    {kRk, "Rk", "_um", kR},
    {kRpk, "Rpk", "_um", kR},        {kRvk, "Rvk", "_um", kR}, {kRmr1, "Rmr1", "_percent", kR},
    {kRmr2, "Rmr2", "_percent", kR},
}};
static_assert(static_cast<std::size_t>(kRmr2) + 1 == kInfos.size());

constexpr std::array<std::string_view, 10> kReasons{
    "",     "filter",      "evaluation_length", "hole_too_long", "section_empty", "below_noise",
    "flat", "no_crossing", "no_element",        "too_few_points"};
static_assert(static_cast<std::size_t>(ProfileReason::kTooFewPoints) + 1 == kReasons.size());

}  // namespace

std::span<const ProfileParameterInfo> profile_parameters() noexcept { return kInfos; }

const ProfileParameterInfo& profile_parameter_info(ProfileParameter parameter) noexcept {
  return kInfos[static_cast<std::size_t>(parameter)];
}

std::optional<ProfileParameter> profile_parameter_from_name(std::string_view name) noexcept {
  const auto found = std::find_if(kInfos.begin(), kInfos.end(), [&](const auto& info) { return info.name == name; });
  if (found == kInfos.end()) return std::nullopt;
  return found->parameter;
}

std::string_view profile_reason_name(ProfileReason reason) noexcept {
  return kReasons[static_cast<std::size_t>(reason)];
}

}  // namespace fvd::metrology
