#include "core/metrology/areal/height_statistics.hpp"

#include <cstdint>

namespace fvd::metrology {

HeightStatistics height_statistics(const HeightField& field, const Region& region, std::vector<double>& heights_um) {
  HeightStatistics found;
  found.survey = survey_region(field, region);
  heights_um.clear();
  if (found.survey.points == 0) return found;
  heights_um = valid_heights_um(field, region, found.survey);
  found.mean_um = mean_height_um(heights_um);
  std::int64_t signs = 0;
  for (double& height_um : heights_um) {
    height_um -= found.mean_um;
    signs += (height_um > 0.0 ? 1 : 0) - (height_um < 0.0 ? 1 : 0);
  }
  found.mean_sign = static_cast<double>(signs) / static_cast<double>(found.survey.points);
  found.moments = height_moments(heights_um);
  return found;
}

}  // namespace fvd::metrology
