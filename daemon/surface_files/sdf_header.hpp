#pragma once

/// The header of an SDF file (ISO 25178-71:2017), binary or ASCII.

#include <cstdint>

#include "daemon/surface_files/file_bytes.hpp"

namespace fvd {

/// Types of a point, by their numbers in the file.
enum class SdfType { kUint8, kUint16, kUint32, kFloat, kInt8, kInt16, kInt32, kDouble };

/// Bytes of a point in a binary file.
[[nodiscard]] std::size_t sdf_type_bytes(SdfType type) noexcept;

/// Whether a stored value stands for a point that was not measured: NaN, infinities, the least value of a signed or
/// floating type.
[[nodiscard]] bool is_sdf_hole(SdfType type, double value) noexcept;

struct SdfHeader {
  GridSize size;
  double pitch_x_um = 0.0;
  double pitch_y_um = 0.0;
  double z_scale_m = 0.0;  ///< of one unit of the stored values
  SdfType type = SdfType::kDouble;
  bool big_endian = false;  ///< binary
};

/// "bISO-1.0" and the like.
inline constexpr std::size_t kSdfMagicBytes = 8;
inline constexpr std::size_t kSdfHeaderBytes = 81;

/// Of a binary file. Throws Error kSurfaceFile, as the next.
[[nodiscard]] SdfHeader read_binary_sdf_header(const FileBytes& file, const SurfaceReadOptions& options);

/// Of an ASCII file, whose stream stands behind the first line, and afterwards behind the "*" of the header.
[[nodiscard]] SdfHeader read_ascii_sdf_header(const FileBytes& file, ByteStream& stream,
                                              const SurfaceReadOptions& options);

}  // namespace fvd
