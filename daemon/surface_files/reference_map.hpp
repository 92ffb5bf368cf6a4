#pragma once

/// The map that flatness is corrected by, from the folder of the calibration.

#include <filesystem>
#include <memory>
#include <string>

#include "core/metrology/height_field.hpp"

namespace fvd {

/// The file of its standard errors: "cal-0003-flatness-sigma.gsf" beside "cal-0003-flatness.gsf".
[[nodiscard]] std::string reference_sigma_name(const std::string& reference);

/// Heights, and standard errors where their file is there, of the reference that the calibration names. Throws Error
/// kSurfaceFile where it is not there, damaged, no plain file name, or the two differ in size. context: thread-safe.
[[nodiscard]] std::shared_ptr<const metrology::HeightField> read_reference_map(const std::filesystem::path& folder,
                                                                               const std::string& reference);

}  // namespace fvd
