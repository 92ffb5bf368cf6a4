#pragma once

/// The formats in which a surface is written, one row each.

#include <span>
#include <string>
#include <string_view>

#include "daemon/export/durable_file.hpp"
#include "daemon/export/surface_view.hpp"

namespace fvd {

struct SurfaceWriter {
  std::string_view format;  ///< as it is asked for
  std::string_view file;    ///< its name in the folder of a result
  bool needs_pitch = true;
  bool needs_sigma = false;
  /// Gives the file's bytes in pieces of at most some MiB, the same for the same surface. What it needs is there.
  /// Throws Error kBadInput for a surface that the format cannot hold.
  void (*write)(const SurfaceView& surface, const ByteSink& sink) = nullptr;
};

[[nodiscard]] std::span<const SurfaceWriter> surface_writers();

/// nullptr for a format that there is not.
[[nodiscard]] const SurfaceWriter* find_surface_writer(std::string_view format) noexcept;

/// Throws Error kBadInput where the surface has not what the format needs.
void write_surface(const SurfaceWriter& writer, const SurfaceView& surface, const ByteSink& sink);
/// All bytes in memory.
[[nodiscard]] std::string surface_bytes(const SurfaceWriter& writer, const SurfaceView& surface);

// The writers. Row 0 is written first; it is the top of the image.

/// X3P (ISO 5436-2:2012): float64 metres, holes as NaN and in valid.bin, both MD5 sums, the origin as JSON in the
/// comment of Record2. Entries are stored, not compressed, and dated 1980-01-01: the same surface gives the same bytes.
/// At most 4 GiB.
void write_x3p(const SurfaceView& surface, const ByteSink& sink);

/// SDF (ISO 25178-71:2017) bISO-1.0, data type 7: float64 metres, holes as NaN. At most 65535 points a side.
void write_sdf(const SurfaceView& surface, const ByteSink& sink);

/// PLY 1.0, binary little-endian, millimetres: x right, y up, z towards the camera. Red, green and blue where the image
/// is known; quality = the standard error of z where that is. Two triangles a cell, one where a point is a hole.
void write_ply(const SurfaceView& surface, const ByteSink& sink);

/// Binary STL with the triangles of the PLY.
void write_stl(const SurfaceView& surface, const ByteSink& sink);

/// Rows of heights in um, "nan" = hole, digits that read back exactly; lines with # in front tell unit, pitch, origin.
void write_csv(const SurfaceView& surface, const ByteSink& sink);

}  // namespace fvd
