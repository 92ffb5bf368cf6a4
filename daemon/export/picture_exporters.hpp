#pragma once

/// Pictures and the report for people, as files of a result.

#include <string>

namespace fvd {

struct ExportInput;

// The exporters. Throw Error kInternal.

[[nodiscard]] std::string sigma_picture_file(const ExportInput& input);
[[nodiscard]] std::string holes_picture_file(const ExportInput& input);
[[nodiscard]] std::string view_picture_file(const ExportInput& input);

[[nodiscard]] std::string texture_view_file(const ExportInput& input);
[[nodiscard]] std::string edge_picture_file(const ExportInput& input);

/// Of input.measurement.
[[nodiscard]] std::string profile_picture_file(const ExportInput& input);

[[nodiscard]] std::string preview_file(const ExportInput& input);
[[nodiscard]] std::string report_file(const ExportInput& input);

}  // namespace fvd
