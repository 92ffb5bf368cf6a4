#pragma once

/// How many bits of a file's grey levels mean something, and what becomes of them: a camera of 12 bits saturates at
/// 4095, also where its files have 16.

#include <cstdint>

#include "core/image/image.hpp"
#include "drivers/replay/image_file.hpp"

namespace fvd {

/// From a file's samples to a slice's grey levels; the same for all slices of a stack.
struct GreyMapping {
  PixelFormat format = PixelFormat::kMono8;
  int bytes_per_sample = 1;  ///< of the files; 4: level = (sample - offset) * scale, of 65535
  int bits = 8;              ///< significant ones; brought to the format's by repeating the upper bits below
  int shift = 0;             ///< bits below them, all 0
  double offset = 0.0;
  double scale = 1.0;

  [[nodiscard]] bool real() const { return bytes_per_sample == static_cast<int>(sizeof(float)); }
};

/// Looks at slices before the stack starts. context: not thread-safe.
class GreySurvey {
 public:
  /// significant_bits: as a person said, 8 to 16; 0: to be seen from the values. Throws ImageFileError if they do not
  /// fit the first image's samples.
  explicit GreySurvey(int significant_bits) : told_bits_(significant_bits) {}

  /// All images have samples of the first one's size; others are passed over. Throws ImageFileError for samples that
  /// are no numbers.
  void add(const ImageFile& image);

  /// No further image can change the mapping.
  [[nodiscard]] bool decided() const;
  /// A few images are not enough: the levels lie below an upper bit's, and no plateau was seen; or they are real
  /// numbers.
  [[nodiscard]] bool wants_all() const;

  /// Bits are recognised if all levels are multiples of 2^shift (high aligned), or the largest level is 2^n - 1 with n
  /// 8, 10, 12 or 14. Real and signed samples from 0 to full scale: 1 for samples up to 1, else the next of 255, 1023,
  /// 4095, 16383, 32767, 65535; the largest sample where that is below an eighth of it. With samples below 0: from the
  /// least to the largest. Throws ImageFileError if the told bits do not fit.
  [[nodiscard]] GreyMapping mapping() const;

 private:
  int told_bits_;
  int bytes_per_sample_ = 0;
  int declared_level_ = 0;
  std::uint32_t most_ = 0;
  std::uint32_t set_bits_ = 0;  ///< of all levels, by "or"
  std::size_t at_most_ = 0;     ///< pixels of the level most_
  double least_real_ = 0.0;
  double most_real_ = 0.0;
  bool real_seen_ = false;
};

/// Brings the samples to the mapping's format. Throws ImageFileError for samples of another size, or a level that the
/// mapping has no place for.
void apply(const GreyMapping& mapping, ImageFile& image);

}  // namespace fvd
