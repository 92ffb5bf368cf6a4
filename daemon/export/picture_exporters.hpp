#pragma once

/// Pictures and the report for people, as files of a result.

#include <string>

namespace fvd {

struct ExportInput;

// The exporters. They are made on request. Throw Error kInternal.

[[nodiscard]] std::string sigma_picture_file(const ExportInput& input);
[[nodiscard]] std::string holes_picture_file(const ExportInput& input);
[[nodiscard]] std::string view_picture_file(const ExportInput& input);

/// Judges the input once more: exporters run before its result is written, and it is the same then.
[[nodiscard]] std::string report_file(const ExportInput& input);

}  // namespace fvd
