#include "core/focus/fit/gap_bias.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/units.hpp"
#include "core/focus/fit/fit_reference.hpp"
#include "core/focus/fit/sample_heights.hpp"

namespace fvd {

namespace {

/// A longer step, over the scan's median, is that over a missing slice.
constexpr double kGap = 1.7;
constexpr int kVertices = 33;

/// One of the four steps about sample i is that over a missing slice.
bool gap_beside(const std::vector<double>& z_um, std::size_t i, double step_um) {
  const std::size_t last = std::min(i + 2, z_um.size() - 1);
  for (std::size_t k = i < 2 ? 0 : i - 2; k < last; ++k) {
    if (std::abs(z_um[k + 1] - z_um[k]) > kGap * step_um) return true;
  }
  return false;
}

}  // namespace

GapBias::GapBias(const std::vector<double>& z_um, const CurveShape& shape) : table_of_(z_um.size(), -1) {
  if (!(shape.width_um > 0.0)) return;
  const ScanCurve model(shape);
  const double step_um = median_step_um(z_um);
  for (std::size_t i = 1; i + 1 < z_um.size(); ++i) {
    if ((z_um[i - 1] - z_um[i]) * (z_um[i + 1] - z_um[i]) >= 0.0 || !gap_beside(z_um, i, step_um)) continue;
    Beside table;
    for (int n = 0; n < kVertices; ++n) {
      // A little beyond the middle to each neighbour, from which on another sample is the largest.
      const double part = 1.3 * (static_cast<double>(n) / (kVertices - 1) - 0.5);
      const double vertex_um = z_um[i] + std::abs(part) * ((part < 0.0 ? z_um[i - 1] : z_um[i + 1]) - z_um[i]);
      const auto sample = [&](std::size_t k) { return ReferenceSample{z_um[k], model.at(z_um[k] - vertex_um)}; };
      ReferenceCurve curve{.peak = sample(i), .left = sample(i - 1), .right = sample(i + 1), .bias = shape.bias};
      if (i >= 2) curve.left2 = sample(i - 2);
      if (i + 2 < z_um.size()) curve.right2 = sample(i + 2);
      const auto fitted = fit_reference(curve);
      if (!fitted) continue;
      table.vertices.push_back({fitted->z_um * kMetresPerMicrometer, vertex_um * kMetresPerMicrometer});
    }
    const auto by_fitted = [](const Vertex& a, const Vertex& b) { return a.fitted_m < b.fitted_m; };
    std::sort(table.vertices.begin(), table.vertices.end(), by_fitted);
    if (table.vertices.size() < 2) continue;
    table_of_[i] = static_cast<int>(tables_.size());
    tables_.push_back(std::move(table));
  }
}

void GapBias::correct(const CurveRow& row, int width, float* height_m) const noexcept {
  if (tables_.empty()) return;
  for (int x = 0; x < width; ++x) {
    const int table = table_of_[row.peak_index[x]];
    if (table < 0 || std::isnan(height_m[x])) continue;
    const std::vector<Vertex>& vertices = tables_[static_cast<std::size_t>(table)].vertices;
    const auto height = static_cast<double>(height_m[x]);
    const auto after = std::upper_bound(vertices.begin() + 1, vertices.end() - 1, height,
                                        [](double value, const Vertex& vertex) { return value < vertex.fitted_m; });
    const Vertex& low = *(after - 1);
    const Vertex& high = *after;
    if (!(high.fitted_m > low.fitted_m)) continue;
    const double part = std::clamp((height - low.fitted_m) / (high.fitted_m - low.fitted_m), 0.0, 1.0);
    // What lies beyond the table keeps its distance from its end.
    const double fitted = low.fitted_m + part * (high.fitted_m - low.fitted_m);
    height_m[x] = static_cast<float>(height - fitted + low.true_m + part * (high.true_m - low.true_m));
  }
}

}  // namespace fvd
