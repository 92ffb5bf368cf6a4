#pragma once

/// One reader for each format of surface files.

#include <filesystem>

#include "daemon/surface_files/surface_files.hpp"

namespace fvd {

// All throw Error kSurfaceFile with the file, the place and the reason, and are thread-safe. Row 0 of the file is row 0
// of the surface: on top.

/// X3P (ISO 5436-2:2012, ISO 25178-72:2017): ZIP with main.xml and binary data of the types I, L, F and D. Both
/// checksums must hold. Refused: profiles and point clouds, absolute lateral axes, rotations, more than one layer,
/// heights inside main.xml.
[[nodiscard]] Surface read_x3p(const std::filesystem::path& path, const SurfaceReadOptions& options = {});

/// Gwyddion Simple Field 1.0 with heights in metres; the lateral unit is m, or px where the caller tells the pitch.
[[nodiscard]] Surface read_gsf(const std::filesystem::path& path, const SurfaceReadOptions& options = {});

/// SDF (ISO 25178-71:2017), versions aBCR-1.0, bBCR-1.0, aISO-1.0, bISO-1.0, data types 0 to 7. Binary ones in either
/// byte order: where the sizes do not fit the file as little-endian, but fit it exactly as big-endian, it is that.
/// Holes: NaN, infinities, BAD in ASCII, the least value of a signed or floating type.
[[nodiscard]] Surface read_sdf(const std::filesystem::path& path, const SurfaceReadOptions& options = {});

/// TIFF of one page of 32-bit or 64-bit floats, heights in metres. The pitch is the caller's: tags hold it in float32.
[[nodiscard]] Surface read_float_tiff(const std::filesystem::path& path, const SurfaceReadOptions& options = {});

/// Numbers row by row with "," ";" tabs or blanks between them; lines with # in front are the header, of "key = value".
/// Its unit (m, mm, um, nm) is required; its pitch_x_um and pitch_y_um, or the caller's. Empty and nan are holes.
[[nodiscard]] Surface read_surface_csv(const std::filesystem::path& path, const SurfaceReadOptions& options = {});

}  // namespace fvd
