#include "sim/artefact/parameter_check.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/artefact/plan.hpp"
#include "sim/artefact/stepped_artefacts.hpp"

namespace fvd::sim {

namespace {

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

}  // namespace

std::vector<BadParameter> bad_parameters(const Groove& groove) {
  const double run_um = wall_run_um(groove);
  if (run_um < groove.width_um) return {};
  return {{"/groove/width_um", "width_um is " + text_of(groove.width_um) + ", and walls of wall_angle_deg " +
                                   text_of(groove.wall_angle_deg) + " meet at a width of " + text_of(run_um) +
                                   " before depth_um " + text_of(groove.depth_um) + ": no bottom is left"}};
}

std::vector<BadParameter> bad_parameters(const CrossGrid& grid) {
  if (grid.line_width_um < std::min(grid.pitch_x_um, grid.pitch_y_um)) return {};
  return {{"/cross_grid/line_width_um", "line_width_um is " + text_of(grid.line_width_um) +
                                            "; expected less than pitch_x_um " + text_of(grid.pitch_x_um) +
                                            " and pitch_y_um " + text_of(grid.pitch_y_um)}};
}

std::vector<BadParameter> bad_parameters(const CuttingEdge& edge, const Tilt& tilt, double reach_um) {
  constexpr double kSteepest_deg = 3.0;  // a flank nearer to the vertical shows nothing
  std::vector<BadParameter> bad;
  const Directed direction(edge.direction_deg);
  const double lean_deg = degrees(std::atan(direction.across(tilt)));
  if (edge.beta_deg / 2.0 - std::abs(lean_deg) < kSteepest_deg) {
    bad.push_back({"/tilt", "the slope across the edge turns it by " + text_of(lean_deg) + " deg; with beta_deg " +
                                text_of(edge.beta_deg) + " at most " + text_of(edge.beta_deg / 2.0 - kSteepest_deg) +
                                " deg, so that no flank overhangs"});
  }
  if (!edge.bend_radius_um) return bad;
  if (std::abs(direction.along(tilt)) > 1e-12) {
    bad.push_back({"/tilt", "an edge with bend_radius_um takes no slope along its direction_deg; this one has " +
                                text_of(direction.along(tilt))});
  }
  if (std::abs(*edge.bend_radius_um) < 2.0 * reach_um) {
    bad.push_back({"/edge/bend_radius_um", "bend_radius_um is " + text_of(*edge.bend_radius_um) +
                                               "; expected at least " + text_of(2.0 * reach_um) + " or at most -" +
                                               text_of(2.0 * reach_um) +
                                               ", twice the way from the image's middle to its corner"});
  }
  return bad;
}

std::vector<BadParameter> bad_parameters(const ContrastMap& contrast) {
  std::vector<BadParameter> bad;
  for (std::size_t i = 0; i < contrast.regions.size(); ++i) {
    const ContrastRegion& region = contrast.regions[i];
    const std::string pointer = "/contrast_map/regions/" + std::to_string(i);
    if (!(region.along_from_um < region.along_to_um)) {
      bad.push_back({pointer + "/along_to_um", "along_to_um is " + text_of(region.along_to_um) +
                                                   "; expected more than along_from_um " +
                                                   text_of(region.along_from_um)});
    }
    if (!(region.across_from_um < region.across_to_um)) {
      bad.push_back({pointer + "/across_to_um", "across_to_um is " + text_of(region.across_to_um) +
                                                    "; expected more than across_from_um " +
                                                    text_of(region.across_from_um)});
    }
  }
  return bad;
}

}  // namespace fvd::sim
