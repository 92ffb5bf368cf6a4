#pragma once

/// main.xml of an X3P file (ISO 5436-2:2012, openGPS specification rev 110).

#include <optional>
#include <string>
#include <string_view>

#include "daemon/surface_files/file_bytes.hpp"

namespace fvd {

/// Links are names of entries of the archive; checksums 32 lower-case digits.
struct X3pDescription {
  enum class Type { kInt16, kInt32, kFloat, kDouble };
  Type type = Type::kDouble;
  GridSize size;
  double pitch_x_um = 0.0;
  double pitch_y_um = 0.0;
  double z_increment_m = 1.0;
  double z_offset_m = 0.0;
  std::string points_link;
  std::string points_md5;
  std::string valid_link;  ///< empty = none
  std::string valid_md5;
  std::string checksum_file;

  [[nodiscard]] std::size_t point_bytes() const noexcept {
    constexpr std::size_t kBytes[] = {2, 4, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
  }
};

/// path: of the X3P file, for the Error kSurfaceFile that it throws with the element and the reason.
[[nodiscard]] X3pDescription read_x3p_main(const std::filesystem::path& path, std::string_view xml,
                                           const SurfaceReadOptions& options);

}  // namespace fvd
