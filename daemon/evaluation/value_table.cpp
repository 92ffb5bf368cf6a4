#include "daemon/evaluation/value_table.hpp"

#include <array>

#include "daemon/evaluation/value_names.hpp"

namespace fvd {

namespace {

constexpr std::string_view kOwn = "own definition";
constexpr std::string_view kA1 = "ISO 5436-1:2000, 7, type A1";
constexpr std::string_view kA2 = "ISO 5436-1:2000, 7, type A2";
constexpr std::string_view kHeights = "ISO 25178-2:2021, height parameters";
constexpr std::string_view kSpatial = "ISO 25178-2:2021, spatial parameters";
constexpr std::string_view kHybrid = "ISO 25178-2:2021, hybrid parameters";
constexpr std::string_view kRatio = "ISO 25178-2:2021, material ratio functions";
constexpr std::string_view kVolume = "ISO 25178-2:2021, volume parameters";
constexpr std::string_view kProfile = "ISO 21920-2:2021, height parameters";
constexpr std::string_view kElement = "ISO 21920-2:2021, feature parameters";
constexpr std::string_view kSlope = "ISO 21920-2:2021, hybrid parameters";
constexpr std::string_view kCurve = "ISO 21920-2:2021, material ratio functions";
constexpr std::string_view kEdgeWords = "ISO 3002-1, DIN 6581 for the word; fit: own definition";

constexpr std::array kMeanings{
    ValueMeaning{"step_height", "height_um",
                 "depth or height, A and B against C, mean of the traces; of a rounded "
                 "bottom its vertex",
                 "ISO 5436-1:2000, 7, types A1 and A2"},
    ValueMeaning{"step_height", "height_areal_um",
                 "the same by one plane over the band, so that tilt along the groove "
                 "does not enter",
                 "areal form of type A1: own definition"},
    ValueMeaning{"step_height", "plain_means_um", "difference of the plain means, for comparison only", kOwn},
    ValueMeaning{"step_height", "width_um", "between the edges", kA1},
    ValueMeaning{"step_height", "bottom_radius_um", "of the rounded bottom, through its middle third", kA2},
    ValueMeaning{"step_between", "height_um", "of the upper region above the lower, along their common normal", kOwn},
    ValueMeaning{"levels", "UPPER-LOWER_um", "of region UPPER above region LOWER, by one plane for all regions", kOwn},
    ValueMeaning{"areal", "Sa_um", "arithmetic mean height", kHeights},
    ValueMeaning{"areal", "Sq_um", "root mean square height", kHeights},
    ValueMeaning{"areal", "Ssk", "skewness", kHeights},
    ValueMeaning{"areal", "Sku", "kurtosis; 3 for a normal distribution", kHeights},
    ValueMeaning{"areal", "Sp_um", "maximum peak height", kHeights},
    ValueMeaning{"areal", "Sv_um", "maximum pit depth, positive", kHeights},
    ValueMeaning{"areal", "Sz_um", "maximum height, Sp + Sv", kHeights},
    ValueMeaning{"areal", "Sdq", "root mean square gradient", kHybrid},
    ValueMeaning{"areal", "Sdr_percent", "developed interfacial area ratio", kHybrid},
    ValueMeaning{"areal", "Sal_um", "autocorrelation length, to 0.2", kSpatial},
    ValueMeaning{"areal", "Str", "texture aspect ratio, at 0.2", kSpatial},
    ValueMeaning{"areal", "Std_deg", "texture direction", kSpatial},
    ValueMeaning{"areal", "Smc_um", "height at a material ratio of 10 %", kRatio},
    ValueMeaning{"areal", "Sxp_um", "extreme peak height, between 2.5 % and 50 %", kRatio},
    ValueMeaning{"areal", "Sk_um", "core height", kRatio},
    ValueMeaning{"areal", "Spk_um", "reduced peak height", kRatio},
    ValueMeaning{"areal", "Svk_um", "reduced pit depth", kRatio},
    ValueMeaning{"areal", "Smr1_percent", "material ratio of the hills, Smrk1", kRatio},
    ValueMeaning{"areal", "Smr2_percent", "material ratio of the dales, Smrk2", kRatio},
    ValueMeaning{"areal", "Vmp_um", "peak material volume above 10 %, for each area", kVolume},
    ValueMeaning{"areal", "Vmc_um", "core material volume between 10 % and 80 %, for each area", kVolume},
    ValueMeaning{"areal", "Vvc_um", "core void volume between 10 % and 80 %, for each area", kVolume},
    ValueMeaning{"areal", "Vvv_um", "pit void volume below 80 %, for each area", kVolume},
    ValueMeaning{"profile", "Pa_um", "arithmetic mean height of the primary profile", kProfile},
    ValueMeaning{"profile", "Pq_um", "root mean square height of the primary profile", kProfile},
    ValueMeaning{"profile", "Pz_um", "maximum height of the primary profile", kProfile},
    ValueMeaning{"profile", "Pt_um", "total height of the primary profile", kProfile},
    ValueMeaning{"profile", "Psk", "skewness of the primary profile", kProfile},
    ValueMeaning{"profile", "Pku", "kurtosis of the primary profile", kProfile},
    ValueMeaning{"profile", "Wa_um", "arithmetic mean height of the waviness", kProfile},
    ValueMeaning{"profile", "Wq_um", "root mean square height of the waviness", kProfile},
    ValueMeaning{"profile", "Wt_um", "total height of the waviness", kProfile},
    ValueMeaning{"profile", "Ra_um", "arithmetic mean height over the evaluation length", kProfile},
    ValueMeaning{"profile", "Rq_um", "root mean square height over the evaluation length", kProfile},
    ValueMeaning{"profile", "Rsk", "skewness", kProfile},
    ValueMeaning{"profile", "Rku", "kurtosis", kProfile},
    ValueMeaning{"profile", "Rt_um", "total height over the evaluation length", kProfile},
    ValueMeaning{"profile", "Rz_um", "maximum height, mean of the sections", kProfile},
    ValueMeaning{"profile", "Rp_um", "mean peak height of the sections", kProfile},
    ValueMeaning{"profile", "Rv_um", "mean pit depth of the sections", kProfile},
    ValueMeaning{"profile", "RSm_um", "mean width of the profile elements", kElement},
    ValueMeaning{"profile", "Rc_um", "mean height of the profile elements", kElement},
    ValueMeaning{"profile", "Rdq", "root mean square slope", kSlope},
    ValueMeaning{"profile", "Rk_um", "core height", kCurve},
    ValueMeaning{"profile", "Rpk_um", "reduced peak height", kCurve},
    ValueMeaning{"profile", "Rvk_um", "reduced pit depth", kCurve},
    ValueMeaning{"profile", "Rmr1_percent", "material ratio of the hills, Rmrk1", kCurve},
    ValueMeaning{"profile", "Rmr2_percent", "material ratio of the dales, Rmrk2", kCurve},
    ValueMeaning{"cutting_edge", "radius_um", "of the rounding, corrected for the focus window", kOwn},
    ValueMeaning{"cutting_edge", "radius_apparent_um", "the same without that correction", kOwn},
    ValueMeaning{"cutting_edge", "beta_deg", "wedge angle between the flanks", kEdgeWords},
    ValueMeaning{"cutting_edge", "S_gamma_um", "from the ideal apex to where the rounding leaves the rake face", kOwn},
    ValueMeaning{"cutting_edge", "S_alpha_um", "likewise the clearance face", kOwn},
    ValueMeaning{"cutting_edge", "K", "S_gamma over S_alpha: above 1 trumpet, below 1 waterfall", kOwn},
    ValueMeaning{"cutting_edge", "delta_r_um", "least distance of the contour from the ideal apex", kOwn},
    ValueMeaning{"cutting_edge", "phi_deg", "its direction against the bisector, positive towards the rake face", kOwn},
    ValueMeaning{"cutting_edge", "r_min_um", "least radius of curvature of the rounding", kOwn},
    ValueMeaning{"cutting_edge", "residual_rms_um", "root mean square distance of the points from the model", kOwn},
    ValueMeaning{"cutting_edge", "edge_Pt_um", "total height of the edge line less its form", kOwn},
    ValueMeaning{"cutting_edge", "edge_Rz_um", "mean maximum height of the edge line's sections", kOwn},
    ValueMeaning{"cutting_edge", "chipping_max_um", "depth of the deepest notch; 0 without one", kOwn},
    ValueMeaning{"cutting_edge", "notches", "number of notches", kOwn},
    ValueMeaning{"cutting_edge", "unmeasured_fraction", "share of the edge that could not be measured", kOwn},
};

}  // namespace

std::span<const ValueMeaning> value_meanings() noexcept { return kMeanings; }

std::string values_markdown() {
  std::string text = "| kind | value | unit | meaning | defined by |\n|---|---|---|---|---|\n";
  for (const ValueMeaning& value : kMeanings) {
    const std::string key(value.key);
    text += "| `" + std::string(value.kind) + "` | `" + key + "` | " + unit_of_key(key) + " | " +
            std::string(value.meaning) + " | " + std::string(value.defined) + " |\n";
  }
  return text;
}

}  // namespace fvd
