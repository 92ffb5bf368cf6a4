#pragma once

/// Heights as a TIFF that every image program opens.

#include <optional>
#include <string>

#include "core/image/image.hpp"

namespace fvd {

struct ExportInput;

struct TiffTags {
  std::string software;
  std::string description;
  std::optional<double> pitch_x_um;  ///< written as resolution in pixels per centimetre where known
  std::optional<double> pitch_y_um;
};

/// The bytes of an uncompressed one-page TIFF: 32-bit IEEE float, metres, NaN = hole. Throws Error kInternal.
[[nodiscard]] std::string encode_height_tiff(const Plane<float>& height_m, const TiffTags& tags);

/// The exporters: heights and standard errors of the input's map.
[[nodiscard]] std::string height_tiff_file(const ExportInput& input);
[[nodiscard]] std::string sigma_tiff_file(const ExportInput& input);
/// Of data.smoothed, which is there.
[[nodiscard]] std::string smooth_height_tiff_file(const ExportInput& input);
[[nodiscard]] std::string smooth_sigma_tiff_file(const ExportInput& input);
/// Of data.repeated, which is there.
[[nodiscard]] std::string repeat_sd_tiff_file(const ExportInput& input);

}  // namespace fvd
