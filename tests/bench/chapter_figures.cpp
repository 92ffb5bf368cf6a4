#include "tests/bench/chapter_figures.hpp"

#include <utility>

namespace fvd::bench {

ChapterFigures chapter_figures(const sim::Surface& surface, const HeightMap& map) {
  constexpr int kBorder_px = 12;  // windows and blur reach so far
  ChapterFigures figures;
  const auto inner = [&](int x, int y) {
    for (const auto& [u, v] :
         {std::pair{x - kBorder_px, y}, {x + kBorder_px, y}, {x, y - kBorder_px}, {x, y + kBorder_px}}) {
      if (u < 0 || v < 0 || u >= map.mask.width() || v >= map.mask.height()) return false;
      if (static_cast<sim::Region>(surface.region.at(u, v)) != sim::Region::kPoor) return false;
    }
    return true;
  };
  for (int y = 0; y < map.mask.height(); ++y) {
    for (int x = 0; x < map.mask.width(); ++x) {
      const auto region = static_cast<sim::Region>(surface.region.at(x, y));
      const double error_um =
          static_cast<double>(map.height_m.at(x, y)) * 1e6 - static_cast<double>(surface.height_um.at(x, y));
      const double sigma_um = static_cast<double>(map.sigma_m.at(x, y)) * 1e6;
      const bool valid = map.mask.at(x, y) == 0;
      if (region == sim::Region::kPoor && inner(x, y)) {
        ++figures.poor_points;
        figures.poor_kept += valid ? 1 : 0;
        figures.poor_wrong += valid && std::abs(error_um) > 5.0 ? 1 : 0;
      }
      if (region == sim::Region::kNone || region == sim::Region::kPoor) continue;
      ++figures.textured;
      if (valid) (region == sim::Region::kRamp ? figures.ramp : figures.plateaus).add(error_um, sigma_um);
    }
  }
  return figures;
}

}  // namespace fvd::bench
