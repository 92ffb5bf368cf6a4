#include "daemon/pipeline/stored_surface.hpp"

#include <utility>

#include "daemon/pipeline/evaluation_input.hpp"
#include "daemon/surface_files/result_folder.hpp"

namespace fvd {

StoredSurface read_stored_surface(const std::filesystem::path& folder, const SurfaceReadOptions& options) {
  ResultSurface read = read_result_surface(folder, options);
  // Not in braces: g++ 12 frees a member twice if the next one's initialiser throws.
  StoredSurface stored;
  stored.context = read_evaluation_context(folder, read.result);
  stored.surface = std::move(read.surface);
  note_window(read.result.focus, stored.surface);
  stored.result = std::move(read.result);
  return stored;
}

}  // namespace fvd
