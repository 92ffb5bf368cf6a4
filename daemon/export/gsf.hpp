#pragma once

/// Gwyddion Simple Field 1.0: text header, 1 to 4 NUL bytes up to a multiple of 4, float32 little-endian row by row,
/// top row first, NaN = hole (http://gwyddion.net/documentation/user-guide-en/gsf.html).

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/image/image.hpp"
#include "daemon/export/durable_file.hpp"

namespace fvd {

struct ExportInput;
struct SurfaceView;

struct GsfHeader {
  std::string title;
  std::optional<double> pitch_x_um;  ///< both absent: lateral unit is px
  std::optional<double> pitch_y_um;
  std::vector<std::pair<std::string, std::string>> metadata;  ///< extra "Key = Value" lines
};

/// The bytes of the file. height_m: metres. Line breaks and control characters in texts become spaces. Lengths are the
/// shortest numbers from which the pitch reads back.
[[nodiscard]] std::string encode_gsf(const Plane<float>& height_m, const GsfHeader& header);

/// The exporter: encode_gsf() of the input's heights, with where they come from.
[[nodiscard]] std::string gsf_file(const ExportInput& input);

/// The scatter of several scans; data.repeated is there.
[[nodiscard]] std::string repeat_sd_gsf_file(const ExportInput& input);

/// The same bytes of any surface, piece by piece: heights, and standard errors, which are there.
void write_gsf(const SurfaceView& surface, const ByteSink& sink);
void write_sigma_gsf(const SurfaceView& surface, const ByteSink& sink);

}  // namespace fvd
