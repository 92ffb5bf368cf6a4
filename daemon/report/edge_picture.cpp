/// Cutting edges as a picture.

#include <algorithm>

#include "daemon/report/edge_plot.hpp"
#include "daemon/report/measurement_pictures.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_page.hpp"
#include "daemon/report/section_title.hpp"
#include "daemon/report/value_rows.hpp"

namespace fvd {

namespace {

constexpr double kMargin = 12.0;
constexpr double kTitle = 40.0;
constexpr double kWords = 14.0;
constexpr double kPanel = 240.0;
constexpr int kWidth = 620;
/// More than a recipe has; a picture of any height is no picture.
constexpr std::size_t kMostEdges = 12;

struct NamedEdge {
  std::string name;
  const EvaluatedMeasurement* measurement;
  EdgeAlong edge;
};

std::vector<NamedEdge> edges_of(const Evaluation& evaluation) {
  std::vector<NamedEdge> edges;
  for (const std::string& name : evaluation.order) {
    const auto found = evaluation.measurements.find(name);
    if (found == evaluation.measurements.end() || edges.size() == kMostEdges) continue;
    if (auto edge = edge_along(found->second)) edges.push_back({name, &found->second, std::move(*edge)});
  }
  return edges;
}

}  // namespace

bool is_cutting_edge(const EvaluatedMeasurement& measurement) { return edge_along(measurement).has_value(); }

std::string edge_png(const PictureSurface& surface, const Evaluation& evaluation) {
  const std::vector<NamedEdge> edges = edges_of(evaluation);
  PicturePage page;
  page.width = kWidth;
  page.height = static_cast<int>(2.0 * kMargin + kTitle +
                                 (kWords + kPanel) * static_cast<double>(std::max<std::size_t>(edges.size(), 1)));
  PictureFile file(page.width, page.height);
  Canvas& canvas = file.canvas();
  draw_page_title(canvas, page, surface, "cutting edge, from section to section; hatched: not measured");
  double y = kMargin + kTitle;
  for (const auto& [name, measurement, edge] : edges) {
    canvas.text({kMargin, y + 8.0}, name + ": " + measurement_text(*measurement),
                {.size = 7.5, .bold = true, .room = kWidth - 2.0 * kMargin});
    const bool is_radius = measurement->main_value == "radius_um";
    draw_edge(canvas, {kMargin, y + kWords, kWidth - 2.0 * kMargin, kPanel - kWords}, edge,
              is_radius ? "radius / µm" : measurement->main_value);
    y += kWords + kPanel;
  }
  return file.bytes();
}

}  // namespace fvd
