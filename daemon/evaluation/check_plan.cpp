#include "daemon/evaluation/check_plan.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>
#include <string_view>

#include "config/nearest_name.hpp"
#include "core/metrology/operations/region.hpp"
#include "daemon/evaluation/field_check.hpp"
#include "daemon/evaluation/value_names.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxNameLength = 32;
constexpr std::size_t kMostLevels = 12;  ///< every pair has a value, and a map of weights

bool is_name(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kMaxNameLength && std::all_of(name.begin(), name.end(), allowed);
}

/// A file of a folder, and of no other: no path can be made of it.
bool is_mask_name(std::string_view name) {
  constexpr std::string_view kSuffix = ".png";
  if (!name.ends_with(kSuffix) || name.starts_with('.')) return false;
  return std::all_of(name.begin(), name.end(), [](char c) { return c == '.' || is_name({&c, 1}); });
}

template <typename Value>
std::vector<std::string> keys_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : values) keys.push_back(key);
  return keys;
}

/// The names that can be reached from `name` by following(name), itself among them where there is a circle.
bool leads_to_itself(const std::string& name,
                     const std::function<std::vector<std::string>(const std::string&)>& following) {
  std::set<std::string> seen;
  std::vector<std::string> waiting = following(name);
  while (!waiting.empty()) {
    const std::string next = waiting.back();
    waiting.pop_back();
    if (next == name) return true;
    if (!seen.insert(next).second) continue;
    const std::vector<std::string> more = following(next);
    waiting.insert(waiting.end(), more.begin(), more.end());
  }
  return false;
}

class Checker {
 public:
  Checker(const EvaluationPlan& plan, std::string place, Problems& problems)
      : plan_(plan), place_(std::move(place)), problems_(problems), read_(problems) {}

  void check() {
    for (const auto& [name, region] : plan_.regions) check_region(name, region);
    for (const Problem& problem : outside_every_field(plan_, "")) refuse(problem.pointer, problem.message);
    for (const auto& [name, surface] : plan_.surfaces) check_surface(name, surface);
    std::map<std::string, std::string> ids;
    for (const auto& [name, measurement] : plan_.measurements) {
      check_measurement(name, measurement);
      const auto [taken, is_new] = ids.emplace(plc_id(name, measurement), name);
      if (is_new) continue;
      refuse("/measurements/" + name + "/id",
             "\"" + taken->first + "\" is the id of " + taken->second + " too, so that a PLC cannot tell them apart");
    }
  }

 private:
  void refuse(const std::string& pointer, const std::string& why) {
    if (!is_reported(read_, place_ + pointer)) problems_.push_back({place_ + pointer, why});
  }

  void check_name(const std::string& pointer, const std::string& name) {
    if (!is_name(name)) refuse(pointer, "expected a name of 1..32 characters out of A-Z a-z 0-9 _ -");
  }

  void check_region_name(const std::string& pointer, const std::string& name) {
    if (plan_.regions.contains(name)) return;
    refuse(pointer,
           "\"" + name + "\" is no region of /evaluation/regions" + did_you_mean(name, keys_of(plan_.regions)));
  }

  void check_region(const std::string& name, const PlannedRegion& region) {
    const std::string pointer = "/regions/" + name;
    check_name(pointer, name);
    if (region.shape == "polygon_um") {
      std::vector<metrology::PointUm> corners;
      for (const PlannedPoint& point : region.polygon) corners.push_back({point.x_um, point.y_um});
      if (const auto problem = metrology::polygon_problem(corners)) refuse(pointer + "/polygon_um", *problem);
    }
    if (region.shape == "mask_png" && !is_mask_name(region.mask_png)) {
      refuse(pointer + "/mask_png",
             "is no name of a PNG file; expected one such as land.png, without a path, out of A-Z a-z 0-9 _ - .");
    }
    if (region.shape == "threshold_um") check_threshold(pointer + "/threshold_um", region);
    if (region.shape == "union" || region.shape == "intersection" || region.shape == "not") {
      if (region.parts.empty()) refuse(pointer + "/" + region.shape, "is empty; expected names of regions");
      for (const std::string& part : region.parts) check_region_name(pointer + "/" + region.shape, part);
      const auto parts_of = [this](const std::string& of) {
        const auto found = plan_.regions.find(of);
        return found == plan_.regions.end() ? std::vector<std::string>() : found->second.parts;
      };
      if (leads_to_itself(name, parts_of)) refuse(pointer + "/" + region.shape, "the region is made of itself");
    }
  }

  void check_threshold(const std::string& pointer, const PlannedRegion& region) {
    if (!region.above_um && !region.below_um) refuse(pointer, "is empty; expected above, below, or both");
    if (region.above_um && region.below_um && *region.above_um >= *region.below_um) {
      refuse(pointer, "above is not less than below, so that no point lies within");
    }
  }

  void check_surface(const std::string& name, const PlannedSurface& surface) {
    const std::string pointer = "/surfaces/" + name;
    check_name(pointer, name);
    if (name == kMeasuredSurface) refuse(pointer, "is the name of the surface that the scan made; expected another");
    check_surface_name(pointer + "/from", surface.from);
    const auto from = [this](const std::string& of) {
      const auto found = plan_.surfaces.find(of);
      return found == plan_.surfaces.end() ? std::vector<std::string>() : std::vector<std::string>{found->second.from};
    };
    if (leads_to_itself(name, from)) refuse(pointer + "/from", "the surface is made of itself");
    for (std::size_t i = 0; i < surface.steps.size(); ++i) {
      check_step(pointer + "/steps/" + std::to_string(i), surface, i);
    }
  }

  void check_surface_name(const std::string& pointer, const std::string& name) {
    if (name == kMeasuredSurface || plan_.surfaces.contains(name)) return;
    refuse(pointer, "\"" + name + "\" is no surface of /evaluation/surfaces, nor \"measured\"" +
                        did_you_mean(name, keys_of(plan_.surfaces)));
  }

  /// Those before it on the way from the measured surface, in any order.
  std::vector<PlannedOperation> earlier_steps(const PlannedSurface& surface, std::size_t index) const {
    std::vector<PlannedOperation> steps(surface.steps.begin(),
                                        surface.steps.begin() + static_cast<std::ptrdiff_t>(index));
    std::set<std::string> seen;
    auto from = plan_.surfaces.find(surface.from);
    while (from != plan_.surfaces.end() && &from->second != &surface && seen.insert(from->first).second) {
      steps.insert(steps.end(), from->second.steps.begin(), from->second.steps.end());
      from = plan_.surfaces.find(from->second.from);
    }
    return steps;
  }

  void check_step(const std::string& pointer, const PlannedSurface& surface, std::size_t index) {
    const PlannedOperation& step = surface.steps[index];
    for (const std::string& region : step.regions) check_region_name(pointer + "/regions", region);
    if (step.op == "outliers" && step.window_px % 2 == 0) {
      refuse(pointer + "/window_px", "is even; expected an odd number so that a point is its centre");
    }
    if (step.op == "mask_reasons" && step.reasons.empty()) {
      refuse(pointer + "/reasons", "is empty; expected one or more of the reasons of holes");
    }
    check_calibration_step(pointer, surface, index);
    if (step.op != "filter") return;
    if (step.side == "S" && step.robust && step.method == "gaussian") {
      refuse(pointer + "/robust", "is for the regression methods; expected gaussian_regression_1 or _2");
    }
    for (const PlannedOperation& before : earlier_steps(surface, index)) {
      if (before.op != "filter" || before.side == step.side) continue;
      const double s_um = before.side == "S" ? before.nesting_um : step.nesting_um;
      const double l_um = before.side == "S" ? step.nesting_um : before.nesting_um;
      if (s_um < l_um) continue;
      std::ostringstream text;
      text << "the S filter's " << s_um << " um and the L filter's " << l_um << " um leave nothing; expected S below L";
      refuse(pointer + "/nesting_um", text.str());
    }
  }

  /// Operations on the way from the measured surface, the last first; from a circle of surfaces only one round.
  [[nodiscard]] std::vector<std::string> operations_before(const PlannedSurface& surface, std::size_t index) const {
    std::vector<std::string> operations;
    for (std::size_t i = index; i > 0; --i) operations.push_back(surface.steps[i - 1].op);
    std::set<std::string> seen;
    auto from = plan_.surfaces.find(surface.from);
    while (from != plan_.surfaces.end() && seen.insert(from->first).second) {
      for (auto step = from->second.steps.rbegin(); step != from->second.steps.rend(); ++step) {
        operations.push_back(step->op);
      }
      from = plan_.surfaces.find(from->second.from);
    }
    return operations;
  }

  void check_calibration_step(const std::string& pointer, const PlannedSurface& surface, std::size_t index) {
    const std::string& op = surface.steps[index].op;
    if (op != "lateral" && op != "flatness_reference") return;
    const std::vector<std::string> before = operations_before(surface, index);
    const auto comes_after = [&before](const char* other) {
      return std::find(before.begin(), before.end(), other) != before.end();
    };
    if (comes_after(op.c_str())) refuse(pointer + "/op", op + " was done to this surface before");
    if (op != "flatness_reference") return;
    for (const char* other : {"lateral", "invert"}) {
      if (!comes_after(other)) continue;
      refuse(pointer + "/op", std::string("comes after ") + other +
                                  ": the reference map is as the scan made it; expected flatness_reference first");
    }
  }

  void check_measurement(const std::string& name, const PlannedMeasurement& measurement) {
    const std::string pointer = "/measurements/" + name;
    check_name(pointer, name);
    check_surface_name(pointer + "/surface", measurement.surface);
    if (!measurement.region.empty()) check_region_name(pointer + "/region", measurement.region);
    if (measurement.kind == "step_between") {
      check_region_name(pointer + "/lower", measurement.lower);
      check_region_name(pointer + "/upper", measurement.upper);
      if (measurement.lower == measurement.upper) refuse(pointer + "/upper", "is the lower region too");
    }
    if (measurement.kind == "levels") {
      if (measurement.regions.size() < 2 || measurement.regions.size() > kMostLevels) {
        refuse(pointer + "/regions", "expected 2.." + std::to_string(kMostLevels) + " regions");
      }
      for (const std::string& region : measurement.regions) check_region_name(pointer + "/regions", region);
    }
    if ((measurement.kind == "areal" || measurement.kind == "profile") && measurement.parameters.empty()) {
      refuse(pointer + "/parameters", "is empty; expected one or more");
    }
    if (measurement.kind == "profile" && measurement.from_um == measurement.to_um) {
      refuse(pointer + "/to_um", "is where the profile begins");
    }
    check_rising(pointer + "/band_from_to_um", measurement.band_from_to_um);
    check_rising(pointer + "/edges_um", measurement.edges_um);
    check_rising(pointer + "/flank_um", measurement.flank_um);
    check_limits(pointer + "/limits", measurement);
  }

  void check_rising(const std::string& pointer, const std::vector<double>& pair) {
    if (pair.empty()) return;
    if (pair.size() != 2 || pair[0] >= pair[1]) refuse(pointer, "expected two numbers, the first the smaller");
  }

  void check_limits(const std::string& pointer, const PlannedMeasurement& measurement) {
    const std::vector<std::string> keys = value_keys(measurement);
    for (const auto& [key, limits] : measurement.limits) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        std::string known;
        for (const std::string& one : keys) known += (known.empty() ? "" : ", ") + one;
        refuse(pointer + "/" + key, "is no value of this measurement; it has " + known + did_you_mean(key, keys));
      } else if (!limits.lower && !limits.upper) {
        refuse(pointer + "/" + key, "is empty; expected lower, upper, or both");
      } else if (limits.lower && limits.upper && *limits.lower > *limits.upper) {
        refuse(pointer + "/" + key, "lower is above upper, so that every value fails");
      }
    }
  }

  const EvaluationPlan& plan_;
  std::string place_;
  Problems& problems_;
  const Problems read_;
};

}  // namespace

void check_plan(const EvaluationPlan& plan, const std::string& place, Problems& problems) {
  Checker(plan, place, problems).check();
}

}  // namespace fvd
