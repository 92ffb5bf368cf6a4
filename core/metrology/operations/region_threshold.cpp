#include "core/metrology/operations/region_threshold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

/// Points of one row that follow each other in the region.
struct Run {
  int row = 0;
  int first = 0;
  int end = 0;
  std::size_t parent = 0;  ///< the run that stands for its part, or nearer to it
};

void check(const ThresholdSettings& settings) {
  const auto fail = [](const char* message) { throw Error(ErrorCode::kBadRecipe, message); };
  if (!settings.above_um && !settings.below_um) fail("a region by height needs `above` or `below`");
  if (settings.above_um && !std::isfinite(*settings.above_um)) fail("`above` of a region by height is not finite");
  if (settings.below_um && !std::isfinite(*settings.below_um)) fail("`below` of a region by height is not finite");
  if (settings.above_um && settings.below_um && *settings.above_um > *settings.below_um) {
    fail("`above` of a region by height must not be larger than `below`");
  }
}

std::size_t root_of(std::vector<Run>& runs, std::size_t run) {
  while (runs[run].parent != run) {
    runs[run].parent = runs[runs[run].parent].parent;
    run = runs[run].parent;
  }
  return run;
}

/// The earlier root stays, so that a part's root is its first run in reading order.
void join(std::vector<Run>& runs, std::size_t left, std::size_t right) {
  const std::size_t a = root_of(runs, left);
  const std::size_t b = root_of(runs, right);
  if (a < b) runs[b].parent = a;
  if (b < a) runs[a].parent = b;
}

/// Joins the runs [first, end) of one row to those [above, first) of the row above.
void join_rows(std::vector<Run>& runs, std::size_t above, std::size_t first) {
  std::size_t upper = above;
  for (std::size_t lower = first; lower < runs.size(); ++lower) {
    while (upper < first && runs[upper].end <= runs[lower].first) ++upper;
    for (std::size_t i = upper; i < first && runs[i].first < runs[lower].end; ++i) join(runs, i, lower);
  }
}

std::vector<Run> joined_runs(const Region& region) {
  std::vector<Run> runs;
  std::size_t above = 0;
  for (int row = 0; row < region.height(); ++row) {
    const std::size_t first = runs.size();
    const std::uint8_t* inside = region.row(row);
    for (int column = 0; column < region.width(); ++column) {
      if (inside[column] == 0) continue;
      const int start = column;
      while (column < region.width() && inside[column] != 0) ++column;
      runs.push_back({row, start, column, runs.size()});
    }
    join_rows(runs, above, first);
    above = first;
  }
  return runs;
}

void keep_largest(ThresholdRegion& found, std::vector<Run>& runs, const std::vector<std::size_t>& points_of) {
  std::size_t largest = 0;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (points_of[i] > points_of[largest]) largest = i;
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (root_of(runs, i) == i && i != largest && points_of[i] == points_of[largest]) found.tie = true;
    if (root_of(runs, i) == largest) continue;
    std::uint8_t* inside = found.region.row(runs[i].row);
    std::fill(inside + runs[i].first, inside + runs[i].end, std::uint8_t{0});
  }
  found.points = points_of[largest];
}

}  // namespace

ThresholdRegion threshold_region(const HeightField& field, const ThresholdSettings& settings) {
  check(settings);
  const double above = settings.above_um.value_or(-std::numeric_limits<double>::infinity());
  const double below = settings.below_um.value_or(std::numeric_limits<double>::infinity());
  ThresholdRegion found;
  found.region = Region::unset(field.width(), field.height());
  for (int row = 0; row < field.height(); ++row) {
    const double* z = field.z_um.row(row);
    std::uint8_t* inside = found.region.row(row);
    for (int column = 0; column < field.width(); ++column) {
      inside[column] = z[column] >= above && z[column] <= below ? 1 : 0;  // false for a hole's NaN
    }
  }
  std::vector<Run> runs = joined_runs(found.region);
  std::vector<std::size_t> points_of(runs.size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto length = static_cast<std::size_t>(runs[i].end - runs[i].first);
    points_of[root_of(runs, i)] += length;
    found.points += length;
    if (root_of(runs, i) == i) ++found.parts;
  }
  if (settings.largest && !runs.empty()) keep_largest(found, runs, points_of);
  return found;
}

}  // namespace fvd::metrology
