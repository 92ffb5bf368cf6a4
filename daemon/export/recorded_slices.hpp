#pragma once

/// Writes the slices of a scan beside its result, so that they can be processed again.

#include <filesystem>
#include <string>

#include "core/image/image.hpp"
#include "daemon/export/atomic_directory.hpp"

namespace fvd {

/// A binary PGM (netpbm "P5"); maxval is the format's largest grey level, so that reading it back restores the format.
[[nodiscard]] std::string encode_pgm(const ImageView& slice);

/// "slice_00000.pgm" of the first slice.
[[nodiscard]] std::string recorded_slice_name(int index);

/// Whether z.txt in the folder of slices says that a device was simulated.
[[nodiscard]] bool recorded_of_simulation(const std::filesystem::path& folder);

/// Writes slices/slice_00000.pgm ... as they come, and their measured z to slices/z.txt in um with every digit a double
/// has: processing the folder gives the same heights bit for bit.
/// context: one thread at a time; nobody else uses the directory meanwhile.
class SliceRecorder {
 public:
  /// directory outlives the recorder.
  explicit SliceRecorder(AtomicDirectory& directory) : directory_(directory) {}

  /// Throws Error kStorageFull, kStorageWrite.
  void add(const ImageView& slice, double z_um);

  /// Writes z.txt; call once, after the last slice. source: a line of text for its head, e.g. the job.
  void finish(const std::string& source, bool simulated);

 private:
  AtomicDirectory& directory_;
  std::string z_lines_;
  int slices_ = 0;
};

}  // namespace fvd
