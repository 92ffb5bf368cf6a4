#pragma once

/// The slices that a job kept beside its result.

#include <filesystem>

#include "core/image/image.hpp"
#include "daemon/export/ome_xml.hpp"
#include "daemon/surface_files/surface_files.hpp"
#include "drivers/replay/image_file.hpp"

namespace fvd::ctl {

/// context: one thread.
class KeptSlices {
 public:
  /// job: the folder of a result. options: the pitch where the result tells none. Reads z.txt and the first slice.
  /// Throws Error kBadInput where the folder has no slices, or not as many as z.txt tells heights; as read(); and
  /// kSurfaceFile for a result.json that cannot be read, or tells another pitch.
  KeptSlices(const std::filesystem::path& job, const SurfaceReadOptions& options);

  /// The name is the part's, or the job's where there is none.
  [[nodiscard]] const OmeStack& stack() const noexcept { return stack_; }

  /// The levels as they were recorded; valid until the next call. Throws Error kBadInput, with its name, for a slice
  /// that is damaged or unlike the first.
  [[nodiscard]] ImageView read(int index);

 private:
  void decode(int index);

  std::filesystem::path folder_;
  OmeStack stack_;
  ImageFile image_;  ///< memory that is used again
};

}  // namespace fvd::ctl
