#include "daemon/evaluation/reason_names.hpp"

#include <array>
#include <string_view>

namespace fvd {

namespace {

struct NamedReason {
  std::string_view name;
  MaskReasons bit;
};

using namespace mask_reason;
constexpr std::array kReasons{NamedReason{"low_prominence", kLowProminence},
                              NamedReason{"first_slice", kFirstSlice},
                              NamedReason{"last_slice", kLastSlice},
                              NamedReason{"not_bracketed", kNotBracketed},
                              NamedReason{"saturated", kSaturated},
                              NamedReason{"insignificant", kInsignificant},
                              NamedReason{"edge_bleeding", kEdgeBleeding},
                              NamedReason{"broad_curve", kBroadCurve},
                              NamedReason{"narrow_curve", kNarrowCurve},
                              NamedReason{"second_peak", kSecondPeak},
                              NamedReason{"edge_band", kEdgeBand},
                              NamedReason{"max_sigma", kMaxSigma},
                              NamedReason{"outlier", kOutlier},
                              NamedReason{"out_of_view", kOutOfView}};

}  // namespace

std::vector<std::string> reason_names() {
  std::vector<std::string> names;
  for (const NamedReason& reason : kReasons) names.emplace_back(reason.name);
  return names;
}

MaskReasons reason_bits(const std::vector<std::string>& names) {
  MaskReasons bits = 0;
  for (const std::string& name : names) {
    for (const NamedReason& reason : kReasons) {
      if (reason.name == name) bits = static_cast<MaskReasons>(bits | reason.bit);
    }
  }
  return bits;
}

}  // namespace fvd
