#pragma once

/// Samples of a TIFF that no image in memory has: packed ones, signed ones, real numbers.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/replay/tiff_handle.hpp"

namespace fvd {

/// How the samples of a page are spread to those of an ImageFile.
class TiffSamples {
 public:
  explicit TiffSamples(const TiffPage& page) : bits_(page.bits), format_(page.sample_format) {}

  /// Whether there is a way: unsigned of 8 to 16 and 32 bits, signed of 8, 16 and 32, real of 32 and 64.
  [[nodiscard]] bool readable() const;
  /// Whether they stand as they should: unsigned of 8 or 16 bits.
  [[nodiscard]] bool plain() const { return is_unsigned() && (bits_ == 8 || bits_ == 16); }
  /// Of a sample once it is spread: 1, 2 (9 to 16 bits), 4 (a float).
  [[nodiscard]] int bytes() const;
  /// 2^bits - 1 of packed samples; else 0.
  [[nodiscard]] int max_level() const { return packed() ? (1 << bits_) - 1 : 0; }

  /// in: `count` samples of one row as libtiff gives them: in the machine's byte order, packed ones with the most
  /// significant bit first. out: resized to count * bytes().
  void spread(const std::byte* in, std::size_t count, std::vector<std::byte>& out) const;

 private:
  [[nodiscard]] bool is_unsigned() const { return format_ == SAMPLEFORMAT_UINT || format_ == SAMPLEFORMAT_VOID; }
  [[nodiscard]] bool packed() const { return is_unsigned() && bits_ > 8 && bits_ < 16; }

  int bits_;
  int format_;
};

}  // namespace fvd
