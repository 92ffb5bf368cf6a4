#include "core/metrology/areal/region_heights.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

/// Calls row(y, z, inside): heights and the region's row, null where all is inside, of the columns of the bounds.
template <typename Row>
void each_row(const HeightField& field, const Region& region, const RegionBounds& bounds, const Row& row) {
  for (int y = bounds.top; y < bounds.bottom; ++y) {
    row(y, field.z_um.row(y) + bounds.left, region.empty() ? nullptr : region.row(y) + bounds.left);
  }
}

bool is_valid(double z, const std::uint8_t* inside, int column) {
  return z == z && (inside == nullptr || inside[column] != 0);
}

}  // namespace

RegionSurvey survey_region(const HeightField& field, const Region& region) {
  assert(region.empty() || (region.width() == field.width() && region.height() == field.height()));
  const RegionBounds asked = bounds_of(region, field.width(), field.height());
  RegionSurvey survey;
  RegionBounds& valid = survey.valid;
  valid = {field.width(), field.height(), 0, 0};
  each_row(field, region, asked, [&](int y, const double* z, const std::uint8_t* inside) {
    std::size_t in_region = 0;
    std::size_t points = 0;
    for (int x = 0; x < asked.width(); ++x) {
      const bool is_asked = inside == nullptr || inside[x] != 0;
      in_region += is_asked ? 1U : 0U;
      points += is_asked && z[x] == z[x] ? 1U : 0U;
    }
    survey.region_points += in_region;
    if (points == 0) return;
    survey.points += points;
    int first = 0;
    while (!is_valid(z[first], inside, first)) ++first;
    int end = asked.width();
    while (!is_valid(z[end - 1], inside, end - 1)) --end;
    valid.left = std::min(valid.left, asked.left + first);
    valid.right = std::max(valid.right, asked.left + end);
    valid.top = std::min(valid.top, y);
    valid.bottom = y + 1;
  });
  if (survey.points == 0) valid = {};
  return survey;
}

std::vector<double> valid_heights_um(const HeightField& field, const Region& region, const RegionSurvey& survey) {
  std::vector<double> heights(survey.points);
  double* next = heights.data();
  each_row(field, region, survey.valid, [&](int, const double* z, const std::uint8_t* inside) {
    for (int x = 0; x < survey.valid.width(); ++x) {
      if (is_valid(z[x], inside, x)) *next++ = z[x];
    }
  });
  assert(next == heights.data() + heights.size());
  return heights;
}

RegionHeights cut_region(const HeightField& field, const Region& region) {
  const RegionSurvey survey = survey_region(field, region);
  RegionHeights cut;
  cut.pitch_x_um = field.pitch_x_um;
  cut.pitch_y_um = field.pitch_y_um;
  cut.points = survey.points;
  cut.region_points = survey.region_points;
  if (cut.points == 0) return cut;
  constexpr int kMargin = RegionHeights::kMargin;
  cut.width = survey.valid.width();
  cut.height = survey.valid.height();
  cut.z_um = Plane<double>(cut.width + 2 * kMargin, cut.height + 2 * kMargin, kHole);
  each_row(field, region, survey.valid, [&](int y, const double* z, const std::uint8_t* inside) {
    double* to = cut.z_um.row(y - survey.valid.top + kMargin) + kMargin;
    for (int x = 0; x < cut.width; ++x) to[x] = is_valid(z[x], inside, x) ? z[x] : kHole;
  });
  return cut;
}

}  // namespace fvd::metrology
