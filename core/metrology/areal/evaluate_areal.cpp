#include "core/metrology/areal/evaluate_areal.hpp"

#include <cassert>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/metrology/areal/autocorrelation.hpp"
#include "core/metrology/areal/gradient.hpp"
#include "core/metrology/areal/height_statistics.hpp"
#include "core/metrology/areal/material_ratio.hpp"
#include "core/metrology/areal/region_heights.hpp"
#include "core/metrology/areal/texture_direction.hpp"

namespace fvd::metrology {
namespace {

/// Below this Sq only rounding is left of a surface: a femtometre.
constexpr double kFlatSqUm = 1e-9;

constexpr const char* kNoPoints = "the region has no valid point";
constexpr const char* kFlat = "the heights do not vary";

template <typename... Parts>
ArealValue none(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return ArealValue::none(text.str());
}

/// What the parameters of one region share, each made when it is first asked for.
class Evaluator {
 public:
  Evaluator(const HeightField& field, const Region& region, const ArealSettings& settings)
      : field_(field),
        region_(region),
        settings_(settings),
        statistics_(height_statistics(field, region, heights_um_)),
        moments_(statistics_.moments) {}

  [[nodiscard]] const HeightStatistics& statistics() const { return statistics_; }

  ArealValue value_of(ArealParameter parameter) {
    if (statistics_.survey.points == 0) return ArealValue::none(kNoPoints);
    switch (parameter) {
      case ArealParameter::kSa:
        return ArealValue::of(moments_.mean_absolute_um);
      case ArealParameter::kSq:
        return ArealValue::of(moments_.root_mean_square_um);
      case ArealParameter::kSp:
        return ArealValue::of(moments_.peak_um);
      case ArealParameter::kSv:
        return ArealValue::of(moments_.pit_um);
      case ArealParameter::kSz:
        return ArealValue::of(moments_.total_um());
      case ArealParameter::kSsk:
        return shape(moments_.skewness);
      case ArealParameter::kSku:
        return shape(moments_.kurtosis);
      case ArealParameter::kSdq:
      case ArealParameter::kSdr:
        return hybrid(parameter);
      case ArealParameter::kSal:
      case ArealParameter::kStr:
      case ArealParameter::kStd:
        return spatial(parameter);
      case ArealParameter::kSk:
      case ArealParameter::kSpk:
      case ArealParameter::kSvk:
      case ArealParameter::kSmr1:
      case ArealParameter::kSmr2:
        return core(parameter);
      case ArealParameter::kSmr:
      case ArealParameter::kSmc:
      case ArealParameter::kSxp:
      case ArealParameter::kVmp:
      case ArealParameter::kVmc:
      case ArealParameter::kVvc:
      case ArealParameter::kVvv:
        return material_ratio(parameter);
    }
    assert(false);
    return ArealValue::none("unknown parameter");
  }

 private:
  ArealValue shape(double value) const {
    const double sq_um = moments_.root_mean_square_um;
    if (sq_um < kFlatSqUm) return ArealValue::none(kFlat);
    if (settings_.noise_floor_um && sq_um < *settings_.noise_floor_um) {
      return none("Sq is ", sq_um, " um, below the noise floor of ", *settings_.noise_floor_um, " um");
    }
    return ArealValue::of(value);
  }

  ArealValue hybrid(ArealParameter parameter) {
    if (parameter == ArealParameter::kSdq) {
      const auto gradient = root_mean_square_gradient(map());
      return gradient ? ArealValue::of(*gradient)
                      : ArealValue::none("no point has valid neighbours on both sides in x and in y");
    }
    const auto ratio = developed_area_ratio_percent(map());
    return ratio ? ArealValue::of(*ratio) : ArealValue::none("no four neighbouring points are valid");
  }

  ArealValue spatial(ArealParameter parameter) {
    if (moments_.root_mean_square_um < kFlatSqUm) return ArealValue::none(kFlat);
    if (parameter == ArealParameter::kStd) return texture_direction_deg(map());
    if (!lengths_)
      lengths_ = autocorrelation_lengths(Autocorrelation(map(), statistics_.mean_um), settings_.acf_threshold);
    const auto& [lengths, reason] = *lengths_;
    if (!lengths) return ArealValue::none(reason);
    return ArealValue::of(parameter == ArealParameter::kSal ? lengths->shortest_um
                                                            : lengths->shortest_um / lengths->longest_um);
  }

  ArealValue core(ArealParameter parameter) {
    if (statistics_.survey.points < settings_.min_points_core) {
      return none("the region has ", statistics_.survey.points, " valid points, fewer than ",
                  settings_.min_points_core);
    }
    if (!core_) core_ = curve().core();
    switch (parameter) {
      case ArealParameter::kSpk:
        return ArealValue::of(core_->peak_um, core_->tie);
      case ArealParameter::kSvk:
        return ArealValue::of(core_->valley_um, core_->tie);
      case ArealParameter::kSmr1:
        return ArealValue::of(core_->ratio1_percent, core_->tie);
      case ArealParameter::kSmr2:
        return ArealValue::of(core_->ratio2_percent, core_->tie);
      default:
        return ArealValue::of(core_->core_um, core_->tie);
    }
  }

  ArealValue material_ratio(ArealParameter parameter) {
    const double peak_percent = settings_.volume_peak_percent;
    const double pit_percent = settings_.volume_pit_percent;
    switch (parameter) {
      case ArealParameter::kSmr:
        if (!settings_.smr_height_um) return ArealValue::none("the height of Smr is not given");
        return ArealValue::of(material_ratio_percent(sorted_um(), *settings_.smr_height_um));
      case ArealParameter::kSmc:
        return ArealValue::of(curve().height_at_um(settings_.smc_ratio_percent));
      case ArealParameter::kSxp:
        return ArealValue::of(curve().height_at_um(settings_.sxp_upper_percent) -
                              curve().height_at_um(settings_.sxp_lower_percent));
      case ArealParameter::kVmp:
        return ArealValue::of(curve().material_volume_um(peak_percent));
      case ArealParameter::kVmc:
        return ArealValue::of(curve().material_volume_um(pit_percent) - curve().material_volume_um(peak_percent));
      case ArealParameter::kVvc:
        return ArealValue::of(curve().void_volume_um(peak_percent) - curve().void_volume_um(pit_percent));
      default:
        return ArealValue::of(curve().void_volume_um(pit_percent));
    }
  }

  const MaterialRatioCurve& curve() {
    if (!curve_) curve_.emplace(sorted_um());
    return *curve_;
  }

  const RegionHeights& map() {
    if (!map_) map_ = cut_region(field_, region_);
    return *map_;
  }

  const std::vector<double>& sorted_um() {
    if (!is_sorted_) heights_um_ = sorted_descending(std::move(heights_um_));
    is_sorted_ = true;
    return heights_um_;
  }

  const HeightField& field_;
  const Region& region_;
  const ArealSettings& settings_;
  std::vector<double> heights_um_;  // about the mean; in descending order once it was asked for
  HeightStatistics statistics_;
  const HeightMoments& moments_;
  bool is_sorted_ = false;
  std::optional<RegionHeights> map_;  // where neighbours count
  std::optional<MaterialRatioCurve> curve_;
  std::optional<CoreParameters> core_;
  std::optional<std::pair<std::optional<AutocorrelationLengths>, std::string>> lengths_;
};

}  // namespace

ArealEvaluation evaluate_areal(const HeightField& field, const Region& region,
                               std::span<const ArealParameter> parameters, const ArealSettings& settings) {
  Evaluator evaluator(field, region, settings);
  ArealEvaluation evaluation;
  evaluation.statistics = evaluator.statistics();
  evaluation.region_points = evaluation.statistics.survey.region_points;
  evaluation.points = evaluation.statistics.survey.points;
  evaluation.mean_um = evaluation.statistics.mean_um;
  evaluation.values.reserve(parameters.size());
  for (const ArealParameter parameter : parameters) evaluation.values.push_back(evaluator.value_of(parameter));
  return evaluation;
}

}  // namespace fvd::metrology
