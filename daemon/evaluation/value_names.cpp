#include "daemon/evaluation/value_names.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "core/metrology/areal/areal_parameters.hpp"
#include "core/metrology/edge/edge_result.hpp"
#include "core/metrology/profile/profile_parameter.hpp"

namespace fvd {

namespace {

/// Smr needs a height that recipes do not say yet.
bool is_offered(metrology::ArealParameter parameter) { return parameter != metrology::ArealParameter::kSmr; }

std::vector<std::string> edge_value_keys(bool with_chipping) {
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < metrology::kEdgeQuantityCount; ++i) {
    keys.emplace_back(metrology::edge_quantity_key(static_cast<metrology::EdgeQuantity>(i)));
  }
  if (!with_chipping) return keys;
  keys.insert(keys.end(), {"edge_Pt_um", "edge_Rz_um", "chipping_max_um", "notches", "unmeasured_fraction"});
  return keys;
}

std::vector<std::string> level_keys(const std::vector<std::string>& regions) {
  std::vector<std::string> keys;
  for (std::size_t lower = 0; lower < regions.size(); ++lower) {
    for (std::size_t upper = lower + 1; upper < regions.size(); ++upper) {
      keys.push_back(level_value_key(regions[upper], regions[lower]));
    }
  }
  return keys;
}

}  // namespace

std::vector<std::string> areal_value_names() {
  std::vector<std::string> names;
  for (const auto& info : metrology::areal_parameters()) {
    if (is_offered(info.parameter)) names.emplace_back(info.name);
  }
  return names;
}

std::vector<std::string> profile_value_names() {
  std::vector<std::string> names;
  for (const auto& info : metrology::profile_parameters()) names.emplace_back(info.name);
  return names;
}

std::string areal_value_key(const std::string& name) {
  const auto parameter = metrology::find_areal_parameter(name);
  return parameter ? name + std::string(metrology::areal_parameter_info(*parameter).key_suffix) : name;
}

std::string profile_value_key(const std::string& name) {
  const auto parameter = metrology::profile_parameter_from_name(name);
  return parameter ? name + std::string(metrology::profile_parameter_info(*parameter).suffix) : name;
}

std::string level_value_key(const std::string& upper, const std::string& lower) { return upper + "-" + lower + "_um"; }

std::vector<std::string> value_keys(const PlannedMeasurement& measurement) {
  if (measurement.kind == "step_height") {
    if (measurement.method == "iso5436_a2") return {"height_um", "width_um", "bottom_radius_um"};
    return {"height_um", "height_areal_um", "plain_means_um", "width_um"};
  }
  if (measurement.kind == "step_between") return {"height_um"};
  if (measurement.kind == "levels") return level_keys(measurement.regions);
  if (measurement.kind == "cutting_edge") return edge_value_keys(measurement.chipping.has_value());
  std::vector<std::string> keys;
  for (const std::string& name : measurement.parameters) {
    keys.push_back(measurement.kind == "areal" ? areal_value_key(name) : profile_value_key(name));
  }
  return keys;
}

ValuePowers value_powers(const std::string& kind, const std::string& key) {
  constexpr ValuePowers kHeight{1.0, 0.0};
  constexpr ValuePowers kInImage{0.0, 1.0};
  if (kind == "cutting_edge") {
    for (const char* length :
         {"radius_um", "radius_apparent_um", "S_gamma_um", "S_alpha_um", "delta_r_um", "r_min_um"}) {
      if (key == length) return kInImage;
    }
    return {};
  }
  if (key == "width_um" && kind == "step_height") return kInImage;
  if (key == "bottom_radius_um" && kind == "step_height") return {-1.0, 2.0};
  if ((key == "Sal_um" && kind == "areal") || (key == "RSm_um" && kind == "profile")) return kInImage;
  if (key == "Sdq" || key == "Rdq") return {1.0, -1.0};
  if (key == "Sdr_percent") return {2.0, -2.0};
  return unit_of_key(key) == "um" ? kHeight : ValuePowers{};
}

std::string unit_of_key(const std::string& key) {
  constexpr std::array<std::pair<std::string_view, const char*>, 4> kUnits{
      {{"_um", "um"}, {"_deg", "deg"}, {"_percent", "%"}, {"_um2", "um2"}}};
  for (const auto& [suffix, unit] : kUnits) {
    if (key.ends_with(suffix)) return unit;
  }
  return "1";
}

}  // namespace fvd
