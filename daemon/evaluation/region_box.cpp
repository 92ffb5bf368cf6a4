#include "daemon/evaluation/region_box.hpp"

#include <algorithm>

namespace fvd {

namespace {

BoxUm hull(const BoxUm& a, const BoxUm& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

/// A side that the image cuts off does not shrink, and the nearest point outside may be a pixel away.
BoxUm shrunk(BoxUm box, double by_um, const metrology::Grid& field) {
  const BoxUm all = box_of(field);
  const auto less = [by_um](double pitch_um) { return std::max(0.0, by_um - pitch_um); };
  if (box.left > all.left + field.pitch_x_um) box.left += less(field.pitch_x_um);
  if (box.right < all.right - field.pitch_x_um) box.right -= less(field.pitch_x_um);
  if (box.top > all.top + field.pitch_y_um) box.top += less(field.pitch_y_um);
  if (box.bottom < all.bottom - field.pitch_y_um) box.bottom -= less(field.pitch_y_um);
  return box;
}

class Boxes {
 public:
  Boxes(const EvaluationPlan& plan, const metrology::Grid* field) : plan_(plan), field_(field) {}

  /// above: the regions that this one is a part of.
  BoxUm of(const std::string& name, std::set<std::string> above) const {
    const auto found = plan_.regions.find(name);
    if (found == plan_.regions.end() || !above.insert(name).second) return {};
    const PlannedRegion& region = found->second;
    BoxUm box = unshrunk(region, above);
    if (field_ == nullptr || region.shrink_um == 0.0) return box;
    return shrunk(common_box(box, box_of(*field_)), region.shrink_um, *field_);
  }

 private:
  BoxUm unshrunk(const PlannedRegion& region, const std::set<std::string>& above) const {
    if (const auto drawn = drawn_box(region)) return *drawn;
    if ((region.shape != "union" && region.shape != "intersection") || region.parts.empty()) return {};
    BoxUm box = of(region.parts.front(), above);
    for (std::size_t i = 1; i < region.parts.size(); ++i) {
      const BoxUm part = of(region.parts[i], above);
      box = region.shape == "union" ? hull(box, part) : common_box(box, part);
    }
    return box;
  }

  const EvaluationPlan& plan_;
  const metrology::Grid* field_;
};

}  // namespace

BoxUm common_box(const BoxUm& a, const BoxUm& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

BoxUm box_of(const PlannedRectangle& rectangle) {
  return {rectangle.x_um, rectangle.y_um, rectangle.x_um + rectangle.width_um, rectangle.y_um + rectangle.height_um};
}

BoxUm box_of(const metrology::Grid& field) {
  return {0.0, 0.0, field.width * field.pitch_x_um, field.height * field.pitch_y_um};
}

std::optional<BoxUm> drawn_box(const PlannedRegion& region) {
  if (region.shape == "rectangle_um") return box_of(region.rectangle);
  if (region.shape == "circle_um") {
    const auto& [x, y] = region.centre;
    return BoxUm{x - region.radius_um, y - region.radius_um, x + region.radius_um, y + region.radius_um};
  }
  if (region.shape != "polygon_um" || region.polygon.empty()) return std::nullopt;
  const auto [left, right] =
      std::minmax_element(region.polygon.begin(), region.polygon.end(),
                          [](const PlannedPoint& a, const PlannedPoint& b) { return a.x_um < b.x_um; });
  const auto [top, bottom] =
      std::minmax_element(region.polygon.begin(), region.polygon.end(),
                          [](const PlannedPoint& a, const PlannedPoint& b) { return a.y_um < b.y_um; });
  return BoxUm{left->x_um, top->y_um, right->x_um, bottom->y_um};
}

BoxUm region_box(const EvaluationPlan& plan, const std::string& name, const metrology::Grid* field) {
  return Boxes(plan, field).of(name, {});
}

}  // namespace fvd
