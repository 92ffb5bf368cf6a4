#include "daemon/result/cross_section.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace fvd {

namespace {

using nlohmann::ordered_json;

CrossSection read(const ordered_json& json) {
  CrossSection section;
  section.from_x_um = json.at("from_um").at(0).get<double>();
  section.from_y_um = json.at("from_um").at(1).get<double>();
  section.to_x_um = json.at("to_um").at(0).get<double>();
  section.to_y_um = json.at("to_um").at(1).get<double>();
  section.band_width_um = json.at("band_width_um").get<double>();
  for (const ordered_json& region : json.at("regions")) {
    section.regions.push_back(
        {region.at("name").get<std::string>(), region.at("from_um").get<double>(), region.at("to_um").get<double>()});
  }
  return section;
}

}  // namespace

double CrossSection::length_um() const { return std::hypot(to_x_um - from_x_um, to_y_um - from_y_um); }

std::string cross_section_json(const CrossSection& section) {
  ordered_json json{{"from_um", {section.from_x_um, section.from_y_um}},
                    {"to_um", {section.to_x_um, section.to_y_um}},
                    {"band_width_um", section.band_width_um},
                    {"regions", ordered_json::array()}};
  for (const CrossSection::Region& region : section.regions) {
    json["regions"].push_back({{"name", region.name}, {"from_um", region.from_um}, {"to_um", region.to_um}});
  }
  return json.dump();
}

std::optional<CrossSection> cross_section_of(const std::string& details) {
  const auto json = ordered_json::parse(details, nullptr, false);
  if (!json.is_object() || !json.contains(kCrossSectionKey)) return std::nullopt;
  try {
    CrossSection section = read(json.at(kCrossSectionKey));
    return section.length_um() > 0.0 ? std::optional(std::move(section)) : std::nullopt;
  } catch (const ordered_json::exception&) {
    return std::nullopt;
  }
}

}  // namespace fvd
