#pragma once

/// Random numbers that do not depend on the standard library.

#include <array>
#include <cstdint>

namespace fvd::metrology {

/// xoshiro256++ (Blackman and Vigna, 2019), its state filled by splitmix64 from seed and stream; normal deviates by the
/// polar form of Box and Muller (Marsaglia, 1964). std::normal_distribution is not used: its values are each library's
/// own. Bits and uniform values are the same everywhere, normal ones up to the last bit of std::log. context: one
/// thread an object.
class RandomNormal {
 public:
  /// Streams of one seed are independent sequences.
  explicit RandomNormal(std::uint64_t seed, std::uint64_t stream = 0);

  [[nodiscard]] std::uint64_t bits();
  /// In [0, 1), a multiple of 2^-53.
  [[nodiscard]] double uniform();
  /// Of mean 0 and standard deviation 1.
  [[nodiscard]] double normal();

 private:
  std::array<std::uint64_t, 4> state_{};
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace fvd::metrology
