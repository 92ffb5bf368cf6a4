/// Writes binary STL: 80 bytes of text, the number of triangles, 50 bytes each.

#include <limits>

#include "core/base/error.hpp"
#include "daemon/export/binary_text.hpp"
#include "daemon/export/surface_mesh.hpp"
#include "daemon/export/surface_writers.hpp"

namespace fvd {

namespace {

constexpr std::size_t kHeader_bytes = 80;

/// Of length 1; 0 where the corners lie on a line.
std::array<float, 3> normal_of(const std::array<std::array<float, 3>, 3>& corners) {
  std::array<double, 3> u{};
  std::array<double, 3> v{};
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = static_cast<double>(corners[1][i]) - static_cast<double>(corners[0][i]);
    v[i] = static_cast<double>(corners[2][i]) - static_cast<double>(corners[0][i]);
  }
  const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (length == 0.0) return {};
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

}  // namespace

void write_stl(const SurfaceView& surface, const ByteSink& sink) {
  std::uint64_t triangles = 0;
  for_each_triangle(surface.height_m, [&triangles](const MeshTriangle&) { ++triangles; });
  if (triangles > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::kBadInput, "stl holds at most 2^32 - 1 triangles, the surface has more");
  }
  std::string header = "fvd surface; unit mm; x right, y up, z towards the camera; " + one_line(surface.origin.title);
  header.resize(kHeader_bytes, ' ');
  const MeshPlaces place_mm(surface);
  BinaryText file(sink);
  file.add_text(header);
  file.add(static_cast<std::uint32_t>(triangles));
  for_each_triangle(surface.height_m, [&](const MeshTriangle& triangle) {
    std::array<std::array<float, 3>, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = place_mm(triangle[i]);
    for (const float value : normal_of(corners)) file.add(value);
    for (const auto& corner : corners) {
      for (const float value : corner) file.add(value);
    }
    file.add(std::uint16_t{0});
  });
  file.flush();
}

}  // namespace fvd
