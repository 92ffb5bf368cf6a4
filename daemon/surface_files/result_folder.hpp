#pragma once

/// Reading back what a job left in its folder.

#include <filesystem>

#include "daemon/result/result.hpp"
#include "daemon/surface_files/surface_files.hpp"

namespace fvd {

/// A result without the pictures for people.
struct ResultSurface {
  Surface surface;
  Result result;  ///< as result.json tells it
};

/// result.json of the folder. Throws Error kSurfaceFile. context: thread-safe.
[[nodiscard]] Result read_result(const std::filesystem::path& folder);

/// Heights from height.tiff, height.gsf, height.sdf or height.x3p, the first that is there, bit for bit as the job had
/// them; sigma_m from sigma.tiff or sigma.gsf; mask from mask.png; the pitch from result.json, of `options` where that
/// tells none. Throws Error kSurfaceFile. context: thread-safe.
[[nodiscard]] ResultSurface read_result_surface(const std::filesystem::path& folder,
                                                const SurfaceReadOptions& options = {});

}  // namespace fvd
