#pragma once

/// The folder of a result as an evaluation takes it: one way for fvdctl and for the daemon.

#include <filesystem>

#include "core/surface/surface.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/result/result.hpp"
#include "daemon/surface_files/surface_files.hpp"

namespace fvd {

struct StoredSurface {
  Surface surface;  ///< with its focus window
  EvaluationContext context;
  Result result;  ///< as result.json tells it
};

/// The same surface and context, bit for bit, that the job was evaluated with. Throws Error kSurfaceFile, kBadInput.
/// context: thread-safe.
[[nodiscard]] StoredSurface read_stored_surface(const std::filesystem::path& folder,
                                                const SurfaceReadOptions& options = {});

}  // namespace fvd
