#include "daemon/evaluation/plan_regions.hpp"

#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/operations/region.hpp"
#include "core/metrology/operations/region_combine.hpp"
#include "core/metrology/operations/region_threshold.hpp"

namespace fvd {

namespace {

using metrology::Grid;
using metrology::HeightField;
using metrology::PointUm;
using metrology::Region;

Region unshrunk(const EvaluationPlan& plan, const PlannedRegion& region, const HeightField& field) {
  const Grid grid = metrology::grid_of(field);
  if (region.shape == "rectangle_um") {
    const PlannedRectangle& r = region.rectangle;
    return metrology::rectangle_region(grid, {r.x_um, r.y_um, r.width_um, r.height_um});
  }
  if (region.shape == "circle_um") {
    return metrology::circle_region(grid, {region.centre.x_um, region.centre.y_um, region.radius_um});
  }
  if (region.shape == "polygon_um") {
    std::vector<PointUm> corners;
    for (const PlannedPoint& corner : region.polygon) corners.push_back({corner.x_um, corner.y_um});
    return metrology::polygon_region(grid, corners);
  }
  if (region.shape == "mask_png") {
    const auto mask = plan.masks.find(region.mask_png);
    if (mask == plan.masks.end()) throw Error(ErrorCode::kBadRecipe, region.mask_png + " was not read");
    if (const auto problem = mask_problem(*mask->second, grid)) {
      throw Error(ErrorCode::kBadRecipe, region.mask_png + " " + *problem);
    }
    return metrology::mask_region(grid, mask->second->points);
  }
  if (region.shape == "threshold_um") {
    return metrology::threshold_region(field, {region.above_um, region.below_um, region.largest}).region;
  }
  Region points = region_points(plan, region.parts.front(), field);
  if (region.shape == "not") return metrology::region_not(points);
  for (std::size_t i = 1; i < region.parts.size(); ++i) {
    const Region other = region_points(plan, region.parts[i], field);
    points = region.shape == "union" ? metrology::region_union(points, other)
                                     : metrology::region_intersection(points, other);
  }
  return points;
}

}  // namespace

std::optional<std::string> mask_problem(const RegionMask& mask, const Grid& grid) {
  const auto size = [](int width, int height) { return std::to_string(width) + " x " + std::to_string(height); };
  if (mask.points.width() == grid.width && mask.points.height() == grid.height) return std::nullopt;
  return "has " + size(mask.points.width(), mask.points.height()) + " points, the surface has " +
         size(grid.width, grid.height) + ": draw the mask on an image of the same size";
}

Region region_points(const EvaluationPlan& plan, const std::string& name, const HeightField& field) {
  if (name.empty()) return {};
  const PlannedRegion& region = plan.regions.at(name);
  Region points = unshrunk(plan, region, field);
  if (region.shrink_um == 0.0) return points;
  return metrology::region_shrink(metrology::grid_of(field), points, region.shrink_um);
}

}  // namespace fvd
