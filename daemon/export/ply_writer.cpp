/// Writes PLY 1.0, binary little-endian.

#include <limits>

#include "daemon/export/binary_text.hpp"
#include "daemon/export/surface_mesh.hpp"
#include "daemon/export/surface_writers.hpp"

namespace fvd {

namespace {

struct Counts {
  std::size_t points = 0;
  std::uint64_t triangles = 0;
};

bool has_colour(const SurfaceView& surface) {
  return surface.colour.data != nullptr || (surface.grey.data != nullptr && surface.max_grey > 0);
}

std::string header_of(const SurfaceView& surface, const Counts& counts) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\n"
      "comment unit mm; x right, y up, z towards the camera\n";
  if (!surface.origin.title.empty()) text += "comment title " + one_line(surface.origin.title) + "\n";
  for (const auto& [key, value] : surface.origin.facts()) text += "comment " + key + " " + one_line(value) + "\n";
  if (surface.sigma_m.data != nullptr) text += "comment quality: standard error of z in mm\n";
  text +=
      "element vertex " + std::to_string(counts.points) + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (has_colour(surface)) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (surface.sigma_m.data != nullptr) text += "property float quality\n";
  return text + "element face " + std::to_string(counts.triangles) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

void add_colour(const SurfaceView& surface, const MeshPoint& point, BinaryText& file) {
  if (surface.colour.data != nullptr) {
    const std::uint8_t* const bgr = surface.colour.row(point.y) + std::ptrdiff_t{3} * point.x;
    for (const std::uint8_t level : {bgr[2], bgr[1], bgr[0]}) file.add(level);
    return;
  }
  constexpr int kWhite = 255;
  const int level = surface.grey.at(point.x, point.y) * kWhite / surface.max_grey;
  for (int i = 0; i < 3; ++i) file.add(static_cast<std::uint8_t>(level));
}

/// Writes the vertices in rows; returns the number of each.
Plane<std::int32_t> number_points(const PlaneView<const float>& height_m, Counts& counts) {
  Plane<std::int32_t> numbers = Plane<std::int32_t>::unset(height_m.width, height_m.height);
  for (int y = 0; y < height_m.height; ++y) {
    for (int x = 0; x < height_m.width; ++x) {
      const bool hole = std::isnan(height_m.at(x, y));
      numbers.at(x, y) = hole ? -1 : static_cast<std::int32_t>(counts.points++);
    }
  }
  return numbers;
}

}  // namespace

void write_ply(const SurfaceView& surface, const ByteSink& sink) {
  const PlaneView<const float>& height_m = surface.height_m;
  Counts counts;
  const Plane<std::int32_t> numbers = number_points(height_m, counts);
  for_each_triangle(height_m, [&counts](const MeshTriangle&) { ++counts.triangles; });
  const MeshPlaces place_mm(surface);
  BinaryText file(sink);
  file.add_text(header_of(surface, counts));
  for (int y = 0; y < height_m.height; ++y) {
    for (int x = 0; x < height_m.width; ++x) {
      if (numbers.at(x, y) < 0) continue;
      for (const float value : place_mm({x, y})) file.add(value);
      if (has_colour(surface)) add_colour(surface, {x, y}, file);
      if (surface.sigma_m.data != nullptr) file.add(surface.sigma_m.at(x, y) * 1e3F);
    }
  }
  for_each_triangle(height_m, [&](const MeshTriangle& triangle) {
    file.add(std::uint8_t{3});
    for (const MeshPoint& corner : triangle) file.add(numbers.at(corner.x, corner.y));
  });
  file.flush();
}

}  // namespace fvd
