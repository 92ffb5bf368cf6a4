#include "core/metrology/areal/material_ratio.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace fvd::metrology {
namespace {

constexpr double kSecantRatio = 0.4;      // ISO 25178-2, ISO 21920-2
constexpr double kLastSecantRatio = 0.6;  // where the last secant begins
constexpr double kLevelShare = 0.05;
constexpr double kSameHeight = 1e-12;  // of the range: heights that differ by rounding only
constexpr double kSameSecant = 1e-9;   // of the smallest: secants that differ by rounding only
constexpr double kApart = 1e-6;        // of the smallest: by so much it must rise between two that tie

/// The curve, straight on beyond its ends, at ratios that do not descend from one call to the next.
template <typename Knot>
class Cursor {
 public:
  explicit Cursor(const std::vector<Knot>& knots) : knots_(knots) {}

  double height_um(double ratio) {
    while (segment_ + 2 < knots_.size() && knots_[segment_ + 1].ratio <= ratio) ++segment_;
    const Knot& from = knots_[segment_];
    const Knot& to = knots_[segment_ + 1];
    return from.height_um + (to.height_um - from.height_um) * ((ratio - from.ratio) / (to.ratio - from.ratio));
  }

 private:
  const std::vector<Knot>& knots_;
  std::size_t segment_ = 0;
};

struct Secant {
  double begin = 0.0;      // its first ratio
  double height_um = 0.0;  // the curve there
  double drop_um = std::numeric_limits<double>::infinity();
};

/// Calls visit(Secant) from the left to the right for every secant that can be the smallest: the drop is piecewise
/// linear in the secant's begin, so that its minimum is where an end of the secant is a knot or the curve ends.
template <typename Knot, typename Visit>
void for_each_secant(const std::vector<Knot>& knots, Visit&& visit) {
  Cursor<Knot> left(knots);
  Cursor<Knot> right(knots);
  const auto take = [&](double begin) {
    const double height_um = left.height_um(begin);
    visit(Secant{begin, height_um, height_um - right.height_um(begin + kSecantRatio)});
  };
  std::size_t at_left = 0;
  std::size_t at_right = 0;
  while (at_right < knots.size() && knots[at_right].ratio <= kSecantRatio) ++at_right;
  take(0.0);
  for (;;) {
    const double next_left = at_left < knots.size() ? knots[at_left].ratio : 1.0;
    const double next_right = at_right < knots.size() ? knots[at_right].ratio - kSecantRatio : 1.0;
    const double begin = std::min(next_left, next_right);
    if (begin >= kLastSecantRatio) break;
    take(begin);
    if (next_left <= begin) ++at_left;
    if (next_right <= begin) ++at_right;
  }
  take(kLastSecantRatio);
}

struct SmallestSecant {
  Secant secant;
  bool tie = false;
};

template <typename Knot>
SmallestSecant smallest_secant(const std::vector<Knot>& knots) {
  double smallest_um = std::numeric_limits<double>::infinity();
  for_each_secant(knots, [&](const Secant& secant) { smallest_um = std::min(smallest_um, secant.drop_um); });
  const double rounding_um = kSameHeight * (knots.front().height_um - knots.back().height_um);
  const double same_um = smallest_um + kSameSecant * smallest_um + rounding_um;
  const double apart_um = smallest_um + kApart * smallest_um + 1e3 * rounding_um;
  SmallestSecant result;
  enum { kBefore, kWithin, kAfter } state = kBefore;
  for_each_secant(knots, [&](const Secant& secant) {
    if (secant.drop_um <= same_um) {
      if (state == kAfter) result.tie = true;
      if (state == kBefore) state = kWithin;
    }
    if (state == kWithin && secant.drop_um > apart_um) state = kAfter;
    if (state == kWithin && secant.drop_um < result.secant.drop_um) result.secant = secant;
  });
  return result;
}

}  // namespace

MaterialRatioCurve::MaterialRatioCurve(std::span<const double> descending) {
  assert(!descending.empty());
  assert(descending.front() >= descending.back());
  const double same_um = kSameHeight * (descending.front() - descending.back());
  const auto count = static_cast<double>(descending.size());
  const auto level_points = static_cast<std::size_t>(kLevelShare * count);
  knots_.reserve(descending.size());
  for (std::size_t first = 0; first < descending.size();) {
    std::size_t end = first + 1;
    while (end < descending.size() && descending[first] - descending[end] <= same_um) ++end;
    const double height_um = 0.5 * (descending[first] + descending[end - 1]);
    const double first_ratio = (static_cast<double>(first) + 0.5) / count;
    const double last_ratio = (static_cast<double>(end) - 0.5) / count;
    if (end - first > std::max<std::size_t>(level_points, 1)) {
      knots_.push_back({first_ratio, height_um});
      knots_.push_back({last_ratio, height_um});
    } else {
      knots_.push_back({0.5 * (first_ratio + last_ratio), height_um});
    }
    first = end;
  }
}

double MaterialRatioCurve::height_of(double ratio) const {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), ratio,
                                      [](double value, const Knot& knot) { return value < knot.ratio; });
  if (after == knots_.begin()) return knots_.front().height_um;
  if (after == knots_.end()) return knots_.back().height_um;
  const Knot& from = *(after - 1);
  return from.height_um + (after->height_um - from.height_um) * ((ratio - from.ratio) / (after->ratio - from.ratio));
}

double MaterialRatioCurve::ratio_between(const Knot& from, const Knot& to, double height_um) {
  return from.ratio + (to.ratio - from.ratio) * ((from.height_um - height_um) / (from.height_um - to.height_um));
}

double MaterialRatioCurve::first_ratio_of(double height_um) const {
  const auto at =
      std::partition_point(knots_.begin(), knots_.end(), [&](const Knot& knot) { return knot.height_um > height_um; });
  if (at == knots_.begin()) return 0.0;
  if (at == knots_.end()) return 1.0;
  return ratio_between(*(at - 1), *at, height_um);
}

double MaterialRatioCurve::last_ratio_of(double height_um) const {
  const auto below =
      std::partition_point(knots_.begin(), knots_.end(), [&](const Knot& knot) { return knot.height_um >= height_um; });
  if (below == knots_.begin()) return 0.0;
  if (below == knots_.end()) return 1.0;
  return ratio_between(*(below - 1), *below, height_um);
}

double MaterialRatioCurve::area_above(double ratio, double height_um) const {
  double area = 0.0;
  Knot from = {0.0, knots_.front().height_um};
  for (const Knot& knot : knots_) {
    if (knot.ratio >= ratio) break;
    area += (knot.ratio - from.ratio) * (0.5 * (from.height_um + knot.height_um) - height_um);
    from = knot;
  }
  return area + (ratio - from.ratio) * (0.5 * (from.height_um + height_of(ratio)) - height_um);
}

double MaterialRatioCurve::area_below(double ratio, double height_um) const {
  double area = 0.0;
  Knot to = {1.0, knots_.back().height_um};
  for (auto knot = knots_.rbegin(); knot != knots_.rend(); ++knot) {
    if (knot->ratio <= ratio) break;
    area += (to.ratio - knot->ratio) * (height_um - 0.5 * (to.height_um + knot->height_um));
    to = *knot;
  }
  return area + (to.ratio - ratio) * (height_um - 0.5 * (to.height_um + height_of(ratio)));
}

double MaterialRatioCurve::height_at_um(double ratio_percent) const { return height_of(ratio_percent / 100.0); }

double MaterialRatioCurve::ratio_at_percent(double height_um) const { return 100.0 * last_ratio_of(height_um); }

double MaterialRatioCurve::material_volume_um(double ratio_percent) const {
  const double ratio = ratio_percent / 100.0;
  return area_above(ratio, height_of(ratio));
}

double MaterialRatioCurve::void_volume_um(double ratio_percent) const {
  const double ratio = ratio_percent / 100.0;
  return area_below(ratio, height_of(ratio));
}

CoreParameters MaterialRatioCurve::core() const {
  CoreParameters core;
  core.core_top_um = knots_.front().height_um;
  core.ratio2_percent = 100.0;
  if (knots_.size() == 1) return core;  // every height is the same
  const auto [secant, tie] = smallest_secant(knots_);
  core.tie = tie;
  core.secant_percent = 100.0 * secant.begin;
  core.core_um = secant.drop_um / kSecantRatio;
  core.core_top_um = secant.height_um + core.core_um * secant.begin;
  const double core_bottom_um = core.core_top_um - core.core_um;
  const double ratio1 = first_ratio_of(core.core_top_um);
  const double ratio2 = last_ratio_of(core_bottom_um);
  core.ratio1_percent = 100.0 * ratio1;
  core.ratio2_percent = 100.0 * ratio2;
  if (ratio1 > 0.0) core.peak_um = 2.0 * area_above(ratio1, core.core_top_um) / ratio1;
  if (ratio2 < 1.0) core.valley_um = 2.0 * area_below(ratio2, core_bottom_um) / (1.0 - ratio2);
  return core;
}

double material_ratio_percent(std::span<const double> descending, double height_um) {
  assert(!descending.empty());
  const auto below =
      std::partition_point(descending.begin(), descending.end(), [&](double height) { return height >= height_um; });
  return 100.0 * static_cast<double>(below - descending.begin()) / static_cast<double>(descending.size());
}

}  // namespace fvd::metrology
