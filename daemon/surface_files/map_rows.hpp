#pragma once

/// Maps in files, of which only the points that are asked for are read where the format lets them be found.

#include <cstddef>
#include <filesystem>
#include <memory>

#include "daemon/surface_files/file_bytes.hpp"

namespace fvd {

/// Values on a regular grid, row 0 on top. context: thread-safe; never changes.
class MapRows {
 public:
  virtual ~MapRows() = default;
  [[nodiscard]] virtual GridSize size() const noexcept = 0;
  /// `count` values of row y from column x on, all within the map; NaN = hole, never an infinity. Throws Error
  /// kSurfaceFile.
  virtual void read(int x, int y, int count, float* to) const = 0;
  /// What is held in memory; 0 = the file is read each time.
  [[nodiscard]] virtual std::size_t bytes() const noexcept { return 0; }
};

/// Heights or standard errors in metres of a TIFF, GSF, SDF or X3P, by its first bytes. An uncompressed TIFF and a GSF
/// are read by the places of their points, the others as a whole, here. The file stays open where it is read later.
/// Throws Error kSurfaceFile.
[[nodiscard]] std::shared_ptr<const MapRows> open_map_rows(const std::filesystem::path& path);

/// Of a TIFF of floats; null where its rows are compressed, which are read as a whole. Throws Error kSurfaceFile.
[[nodiscard]] std::shared_ptr<const MapRows> open_tiff_rows(const std::filesystem::path& path);

/// Of a Gwyddion Simple Field. Throws Error kSurfaceFile.
[[nodiscard]] std::shared_ptr<const MapRows> open_gsf_rows(const std::filesystem::path& path);

}  // namespace fvd
