#include "daemon/report/surface_digest.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <glib.h>

namespace fvd {

namespace {

constexpr std::uint32_t kHoleBits = 0x7FC00000U;

struct ChecksumFree {
  void operator()(GChecksum* checksum) const noexcept { g_checksum_free(checksum); }
};

}  // namespace

std::string surface_sha256(const PlaneView<const float>& height_m) {
  static_assert(std::endian::native == std::endian::little);
  const std::unique_ptr<GChecksum, ChecksumFree> checksum(g_checksum_new(G_CHECKSUM_SHA256));
  std::vector<std::uint32_t> bits(static_cast<std::size_t>(height_m.width));
  for (int y = 0; y < height_m.height; ++y) {
    const float* const row = height_m.row(y);
    for (std::size_t x = 0; x < bits.size(); ++x) {
      bits[x] = std::isnan(row[x]) ? kHoleBits : std::bit_cast<std::uint32_t>(row[x]);
    }
    g_checksum_update(checksum.get(), reinterpret_cast<const guchar*>(bits.data()),
                      static_cast<gssize>(bits.size() * sizeof bits[0]));
  }
  return g_checksum_get_string(checksum.get());
}

}  // namespace fvd
