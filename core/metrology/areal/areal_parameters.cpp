#include "core/metrology/areal/areal_parameters.hpp"

#include <array>
#include <cassert>

namespace fvd::metrology {
namespace {

constexpr std::array<ArealParameterInfo, kArealParameterCount> kTable = {{
    {ArealParameter::kSa, "Sa", "_um", "um"},
    {ArealParameter::kSq, "Sq", "_um", "um"},
    {ArealParameter::kSsk, "Ssk", "", ""},
    {ArealParameter::kSku, "Sku", "", ""},
    {ArealParameter::kSp, "Sp", "_um", "um"},
    {ArealParameter::kSv, "Sv", "_um", "um"},
    {ArealParameter::kSz, "Sz", "_um", "um"},
    {ArealParameter::kSdq, "Sdq", "", ""},
    {ArealParameter::kSdr, "Sdr", "_percent", "%"},
    {ArealParameter::kSal, "Sal", "_um", "um"},
    {ArealParameter::kStr, "Str", "", ""},
    {ArealParameter::kStd, "Std", "_deg", "deg"},
    {ArealParameter::kSmr, "Smr", "_percent", "%"},
    {ArealParameter::kSmc, "Smc", "_um", "um"},
    {ArealParameter::kSxp, "Sxp", "_um", "um"},
    {ArealParameter::kSk, "Sk", "_um", "um"},
    {ArealParameter::kSpk, "Spk", "_um", "um"},
    {ArealParameter::kSvk, "Svk", "_um", "um"},
    {ArealParameter::kSmr1, "Smr1", "_percent", "%"},
    {ArealParameter::kSmr2, "Smr2", "_percent", "%"},
    {ArealParameter::kVmp, "Vmp", "_um", "um3/um2"},
    {ArealParameter::kVmc, "Vmc", "_um", "um3/um2"},
    {ArealParameter::kVvc, "Vvc", "_um", "um3/um2"},
    {ArealParameter::kVvv, "Vvv", "_um", "um3/um2"},
}};

}  // namespace

std::span<const ArealParameterInfo, kArealParameterCount> areal_parameters() { return kTable; }

const ArealParameterInfo& areal_parameter_info(ArealParameter parameter) {
  const auto& info = kTable[static_cast<std::size_t>(parameter)];
  assert(info.parameter == parameter);
  return info;
}

std::optional<ArealParameter> find_areal_parameter(std::string_view name) {
  if (name == "Smrk1") return ArealParameter::kSmr1;
  if (name == "Smrk2") return ArealParameter::kSmr2;
  for (const ArealParameterInfo& info : kTable) {
    if (info.name == name) return info.parameter;
  }
  return std::nullopt;
}

}  // namespace fvd::metrology
