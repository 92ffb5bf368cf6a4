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

/// Whether a regular file is there, and no link to one.
[[nodiscard]] bool is_plain_file(const std::filesystem::path& path);

/// The files that read_result_surface() takes heights and standard errors from, as far as they are plain files; empty =
/// there is none. context: thread-safe.
[[nodiscard]] std::filesystem::path heights_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path sigma_file(const std::filesystem::path& folder);

}  // namespace fvd
