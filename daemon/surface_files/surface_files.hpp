#pragma once

/// Reading a surface from a file or from the folder of a result, whatever its format.

#include <filesystem>
#include <optional>

#include "core/surface/surface.hpp"

namespace fvd {

/// What the caller knows beside the file.
struct SurfaceReadOptions {
  /// Distance of the points, both or none. Needed where the file does not tell it; refused where the file tells
  /// another.
  std::optional<double> pitch_x_um;
  std::optional<double> pitch_y_um;
};

/// The surface of a result's folder, or of an X3P, GSF, SDF, float TIFF or CSV file, which is told by its first bytes;
/// CSV by its name. NaN, infinities and points that the file's mask leaves out are holes. Takes at most 64 MiB beside
/// the surface itself. Throws Error kSurfaceFile with the file, the place (byte, element or line) and the reason.
/// context: thread-safe.
[[nodiscard]] Surface read_surface(const std::filesystem::path& path, const SurfaceReadOptions& options = {});

}  // namespace fvd
