#include "core/metrology/uncertainty/random_normal.hpp"

#include <bit>
#include <cmath>

namespace fvd::metrology {
namespace {

std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t mixed = state;
  mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
  mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
  return mixed ^ (mixed >> 31U);
}

}  // namespace

RandomNormal::RandomNormal(std::uint64_t seed, std::uint64_t stream) {
  // The seed is mixed before the stream is added, so that (seed, stream + 1) and (seed + 1, stream) differ.
  std::uint64_t mixing = seed;
  std::uint64_t filling = splitmix64(mixing) ^ (stream * 0xd1342543de82ef95U + 1U);
  for (std::uint64_t& word : state_) word = splitmix64(filling);
}

std::uint64_t RandomNormal::bits() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t shifted = state_[1] << 17U;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double RandomNormal::uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }

double RandomNormal::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double x = 0.0;
  double y = 0.0;
  double squared = 0.0;
  do {
    x = 2.0 * uniform() - 1.0;
    y = 2.0 * uniform() - 1.0;
    squared = x * x + y * y;
  } while (squared >= 1.0 || squared == 0.0);
  const double scale = std::sqrt(-2.0 * std::log(squared) / squared);
  spare_ = y * scale;
  has_spare_ = true;
  return x * scale;
}

}  // namespace fvd::metrology
