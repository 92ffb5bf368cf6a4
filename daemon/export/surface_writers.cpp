#include "daemon/export/surface_writers.hpp"

#include <algorithm>
#include <array>

#include "core/base/error.hpp"
#include "daemon/export/gsf.hpp"

namespace fvd {

std::span<const SurfaceWriter> surface_writers() {
  static constexpr std::array kWriters{
      SurfaceWriter{"x3p", "height.x3p", true, false, write_x3p},
      SurfaceWriter{"gsf", "height.gsf", false, false, write_gsf},
      SurfaceWriter{"gsf_sigma", "sigma.gsf", false, true, write_sigma_gsf},
      SurfaceWriter{"sdf", "height.sdf", true, false, write_sdf},
      SurfaceWriter{"ply", "height.ply", true, false, write_ply},
      SurfaceWriter{"stl", "height.stl", true, false, write_stl},
      SurfaceWriter{"csv", "height.csv", true, false, write_csv},
  };
  return kWriters;
}

const SurfaceWriter* find_surface_writer(std::string_view format) noexcept {
  const auto writers = surface_writers();
  const auto found = std::find_if(writers.begin(), writers.end(),
                                  [&](const SurfaceWriter& writer) { return writer.format == format; });
  return found == writers.end() ? nullptr : &*found;
}

void write_surface(const SurfaceWriter& writer, const SurfaceView& surface, const ByteSink& sink) {
  const std::string format(writer.format);
  if (writer.needs_pitch && !surface.is_metric()) {
    throw Error(ErrorCode::kBadInput, "the distance of the points is not known: " + format + " needs it");
  }
  if (writer.needs_sigma && surface.sigma_m.data == nullptr) {
    throw Error(ErrorCode::kBadInput, "the standard errors of the heights are not known: " + format + " needs them");
  }
  writer.write(surface, sink);
}

std::string surface_bytes(const SurfaceWriter& writer, const SurfaceView& surface) {
  std::string bytes;
  write_surface(writer, surface, [&bytes](std::string_view piece) { bytes += piece; });
  return bytes;
}

}  // namespace fvd
