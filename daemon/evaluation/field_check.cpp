#include "daemon/evaluation/field_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "daemon/evaluation/plan_regions.hpp"
#include "daemon/evaluation/region_box.hpp"

namespace fvd {

namespace {

using metrology::Grid;

/// Ends within this share of the field of its border lie on it.
constexpr double kOnBorder = 1e-9;
/// A shape is sampled by so many points in either direction where its area has no simple form.
constexpr int kSamples = 400;
/// Less than this lies outside by the rounding of what people typed.
constexpr double kLeastShare = 1e-3;

std::string box_text(const BoxUm& box) {
  std::ostringstream text;
  text << "x " << box.left << " to " << box.right << ", y " << box.top << " to " << box.bottom << " um";
  return text.str();
}

std::string field_text(const Grid& field) {
  std::ostringstream text;
  text << "the field of view is " << field.width * field.pitch_x_um << " x " << field.height * field.pitch_y_um
       << " um (" << field.width << " x " << field.height << " pixels)";
  return text.str();
}

bool has_point(const Grid& field, const BoxUm& box) {
  const BoxUm seen = common_box(box, box_of(field));
  if (seen.empty()) return false;
  return !metrology::pixels_in(field, {seen.left, seen.top, seen.right - seen.left, seen.bottom - seen.top}).empty();
}

class FieldChecker {
 public:
  FieldChecker(const EvaluationPlan& plan, const Grid& field, std::string place)
      : plan_(plan), field_(field), place_(std::move(place)) {}

  Problems check() {
    for (const auto& [name, region] : plan_.regions) check_region(name, region);
    for (const auto& [name, surface] : plan_.surfaces) {
      for (std::size_t i = 0; i < surface.steps.size(); ++i) {
        if (surface.steps[i].op != "crop" || has_point(field_, box_of(surface.steps[i].rectangle))) continue;
        refuse("/surfaces/" + name + "/steps/" + std::to_string(i) + "/rectangle_um",
               "has no point: it lies at " + box_text(box_of(surface.steps[i].rectangle)));
      }
    }
    for (const auto& [name, planned] : plan_.measurements) check_measurement("/measurements/" + name, planned);
    return std::move(problems_);
  }

 private:
  void refuse(const std::string& pointer, const std::string& why) {
    problems_.push_back({place_ + pointer, why + "; " + field_text(field_)});
  }

  void check_region(const std::string& name, const PlannedRegion& region) {
    if (const auto mask = plan_.masks.find(region.mask_png); region.shape == "mask_png" && mask != plan_.masks.end()) {
      const auto problem = mask_problem(*mask->second, field_);
      if (problem) refuse("/regions/" + name + "/mask_png", region.mask_png + " " + *problem);
    }
    const BoxUm box = region_box(plan_, name, &field_);
    if (has_point(field_, box)) return;
    const std::string pointer = "/regions/" + name + "/" + region.shape;
    if (const auto drawn = drawn_box(region); drawn && !has_point(field_, *drawn)) {
      refuse(pointer, "lies outside, at " + box_text(*drawn));
    } else if (region.shrink_um > 0.0) {
      refuse("/regions/" + name + "/shrink_um", "leaves no point of the region");
    } else {
      refuse(pointer, "has no point in the field of view");
    }
  }

  void check_range(const std::string& pointer, const std::vector<double>& range, double end_um, const char* what) {
    if (range.size() != 2) return;
    const double slack_um = kOnBorder * end_um;
    if (range[0] >= -slack_um && range[1] <= end_um + slack_um) return;
    std::ostringstream text;
    text << what << " of " << range[0] << " to " << range[1] << " um lies outside of 0 to " << end_um << " um";
    refuse(pointer, text.str());
  }

  void check_end(const std::string& pointer, const std::vector<double>& end) {
    if (end.size() != 2) return;
    const BoxUm all = box_of(field_);
    const double slack_um = kOnBorder * (all.right + all.bottom);
    const bool inside =
        end[0] >= -slack_um && end[1] >= -slack_um && end[0] <= all.right + slack_um && end[1] <= all.bottom + slack_um;
    if (inside) return;
    std::ostringstream text;
    text << "the profile's end at " << end[0] << ", " << end[1] << " um lies outside";
    refuse(pointer, text.str());
  }

  void check_measurement(const std::string& pointer, const PlannedMeasurement& planned) {
    const BoxUm all = box_of(field_);
    if (planned.kind == "step_height") {
      const bool across_x = planned.across != "y";
      check_range(pointer + "/band_from_to_um", planned.band_from_to_um, across_x ? all.bottom : all.right, "the band");
      check_range(pointer + "/edges_um", planned.edges_um, across_x ? all.right : all.bottom, "the groove");
    }
    if (planned.kind != "profile") return;
    check_end(pointer + "/from_um", planned.from_um);
    check_end(pointer + "/to_um", planned.to_um);
  }

  const EvaluationPlan& plan_;
  const Grid& field_;
  std::string place_;
  Problems problems_;
};

/// Where the shape does not lie within the field: the share of its area outside, else nothing.
std::optional<double> share_outside(const PlannedRegion& region, const Grid& field) {
  const auto drawn = drawn_box(region);
  if (!drawn) return std::nullopt;
  const BoxUm all = box_of(field);
  const bool inside =
      drawn->left >= all.left && drawn->top >= all.top && drawn->right <= all.right && drawn->bottom <= all.bottom;
  if (inside) return std::nullopt;
  const double width_um = drawn->right - drawn->left;
  const double height_um = drawn->bottom - drawn->top;
  const Grid grid{kSamples, kSamples, width_um / kSamples, height_um / kSamples};
  metrology::Region shape;
  if (region.shape == "circle_um") {
    shape = metrology::circle_region(
        grid, {region.centre.x_um - drawn->left, region.centre.y_um - drawn->top, region.radius_um});
  } else if (region.shape == "polygon_um") {
    std::vector<metrology::PointUm> corners;
    for (const auto& [x_um, y_um] : region.polygon) corners.push_back({x_um - drawn->left, y_um - drawn->top});
    shape = metrology::polygon_region(grid, corners);
  } else {
    const BoxUm seen = common_box(*drawn, all);
    const double area_um2 = seen.empty() ? 0.0 : (seen.right - seen.left) * (seen.bottom - seen.top);
    return 1.0 - area_um2 / (width_um * height_um);
  }
  const std::size_t points = metrology::count_points(shape);
  if (points == 0) return std::nullopt;
  std::size_t within = 0;
  for (int row = 0; row < kSamples; ++row) {
    const double y_um = drawn->top + (row + 0.5) * grid.pitch_y_um;
    if (y_um < all.top || y_um > all.bottom) continue;
    for (int column = 0; column < kSamples; ++column) {
      const double x_um = drawn->left + (column + 0.5) * grid.pitch_x_um;
      if (shape.at(column, row) != 0 && x_um >= all.left && x_um <= all.right) ++within;
    }
  }
  return 1.0 - static_cast<double>(within) / static_cast<double>(points);
}

/// The band of a profile as a region; nothing for a line.
std::optional<PlannedRegion> band_of(const PlannedMeasurement& planned) {
  if (planned.kind != "profile" || planned.band_width_um == 0.0) return std::nullopt;
  const double dx = planned.to_um.at(0) - planned.from_um.at(0);
  const double dy = planned.to_um.at(1) - planned.from_um.at(1);
  const double half = planned.band_width_um / 2.0 / std::hypot(dx, dy);
  PlannedRegion band;
  band.shape = "polygon_um";
  for (const auto& [end, side] : {std::pair{&planned.from_um, -half}, std::pair{&planned.to_um, -half},
                                  std::pair{&planned.to_um, half}, std::pair{&planned.from_um, half}}) {
    band.polygon.push_back({end->at(0) - side * dy, end->at(1) + side * dx});
  }
  return band;
}

/// The regions that are looked at, with what they are made of.
void add_with_parts(const EvaluationPlan& plan, const std::string& name, std::set<std::string>& names) {
  const auto found = plan.regions.find(name);
  if (found == plan.regions.end() || !names.insert(name).second) return;
  for (const std::string& part : found->second.parts) add_with_parts(plan, part, names);
}

}  // namespace

std::set<std::string> used_regions(const EvaluationPlan& plan, const PlannedMeasurement& planned) {
  std::set<std::string> names;
  for (const std::string& name : {planned.region, planned.lower, planned.upper}) add_with_parts(plan, name, names);
  for (const std::string& name : planned.regions) add_with_parts(plan, name, names);
  for (auto surface = plan.surfaces.find(planned.surface); surface != plan.surfaces.end();
       surface = plan.surfaces.find(surface->second.from)) {
    for (const PlannedOperation& step : surface->second.steps) {
      for (const std::string& name : step.regions) add_with_parts(plan, name, names);
    }
  }
  return names;
}

Problems outside_every_field(const EvaluationPlan& plan, const std::string& place) {
  Problems problems;
  for (const auto& [name, region] : plan.regions) {
    const BoxUm box = region_box(plan, name, nullptr);
    const std::string pointer = place + "/regions/" + name + "/" + region.shape;
    if (drawn_box(region) && (box.right <= 0.0 || box.bottom <= 0.0)) {
      problems.push_back({pointer, "lies left of or above every field of view, at " + box_text(box) +
                                       "; x and y count from the outer corner of the first pixel"});
    } else if (region.shape == "intersection" && box.empty()) {
      problems.push_back({pointer, "is empty: the regions lie apart"});
    }
  }
  return problems;
}

Problems outside_field(const EvaluationPlan& plan, const Grid& field, const std::string& place) {
  return FieldChecker(plan, field, place).check();
}

std::vector<EvaluationWarning> partly_outside(const EvaluationPlan& plan, const PlannedMeasurement& planned,
                                              const Grid& field) {
  std::vector<EvaluationWarning> warnings;
  const auto tell = [&](const std::string& what, const PlannedRegion& region) {
    const auto share = share_outside(region, field);
    if (!share || *share < kLeastShare) return;
    std::ostringstream text;
    text.precision(3);
    text << 100.0 * *share << " % of " << what << " lie outside of the field of view and were not looked at";
    warnings.push_back({"region_partly_outside", text.str()});
  };
  for (const std::string& name : used_regions(plan, planned)) tell("the region " + name, plan.regions.at(name));
  if (const auto band = band_of(planned)) tell("the profile's band", *band);
  return warnings;
}

}  // namespace fvd
