#pragma once

/// A recorded focus stack: slices on disk, read one at a time.

#include <filesystem>

#include "core/image/image.hpp"
#include "drivers/replay/slice_files.hpp"
#include "drivers/replay/slice_image.hpp"

namespace fvd {

/// Holds names, never pixels. All slices have the size and format of the first.
/// context: const functions are thread-safe.
class RecordedStack {
 public:
  /// source: a folder of slices or a multi-page TIFF, see find_slices() for which files count. Reads the first slice.
  /// Throws Error kBadInput, naming the file: see find_slices(), read_slice().
  explicit RecordedStack(const std::filesystem::path& source) : RecordedStack(find_slices(source)) {}
  /// Of slices that were found before. Looks at a few where they have more than 8 bits. significant_bits: see
  /// GreySurvey; 0 = seen from the levels.
  explicit RecordedStack(SliceList list, int significant_bits = 0);

  [[nodiscard]] const SliceList& list() const noexcept { return list_; }
  [[nodiscard]] int slices() const noexcept { return static_cast<int>(list_.slices.size()); }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] PixelFormat format() const noexcept { return format_; }
  /// How the levels of the files become those of the slices.
  [[nodiscard]] const GreyMapping& mapping() const noexcept { return mapping_; }
  /// Whether the first slice has colours; the others need not agree.
  [[nodiscard]] bool colour() const noexcept { return colour_; }

  /// Decodes one slice, 0 <= index < slices(), into `slice`, whose memory it reuses. Throws Error kBadInput naming
  /// the file: see read_slice(); also for another size or format than the first slice's.
  void read(int index, SliceImage& slice) const;

  [[nodiscard]] SliceImage read(int index) const {
    SliceImage slice;
    read(index, slice);
    return slice;
  }

 private:
  SliceList list_;
  int width_ = 0;
  int height_ = 0;
  GreyMapping mapping_;
  PixelFormat format_ = PixelFormat::kMono8;
  bool colour_ = false;
};

}  // namespace fvd
