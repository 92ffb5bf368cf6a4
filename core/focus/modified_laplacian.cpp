#include "core/focus/modified_laplacian.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/focus/vector_clones.hpp"

namespace fvd {

namespace {

template <typename Pixel>
LaplacianOf<Pixel> laplacian(int left, int right, int above, int below, int centre) {
  return static_cast<LaplacianOf<Pixel>>(std::abs(2 * centre - left - right) + std::abs(2 * centre - above - below));
}

template <typename Pixel, typename Wide>
inline __attribute__((always_inline)) void interior(const Pixel* __restrict above, const Pixel* __restrict row,
                                                    const Pixel* __restrict below, int width,
                                                    LaplacianOf<Pixel>* __restrict out) {
  for (int x = 1; x < width - 1; ++x) {
    const auto twice = static_cast<Wide>(2 * row[x]);
    const auto horizontal = static_cast<Wide>(twice - row[x - 1] - row[x + 1]);
    const auto vertical = static_cast<Wide>(twice - above[x] - below[x]);
    out[x] = static_cast<LaplacianOf<Pixel>>((horizontal < 0 ? -horizontal : horizontal) +
                                             (vertical < 0 ? -vertical : vertical));
  }
}

// Clones need a plain function each. 8 bit: the differences lie within -510..510, so 16-bit lanes do.
FVD_VECTOR_CLONES void interior_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                                    int width, std::uint16_t* out) {
  interior<std::uint8_t, std::int16_t>(above, row, below, width, out);
}
FVD_VECTOR_CLONES void interior_row(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                                    int width, std::uint32_t* out) {
  interior<std::uint16_t, std::int32_t>(above, row, below, width, out);
}

}  // namespace

template <typename Pixel>
void modified_laplacian_row_scalar(const Pixel* above, const Pixel* row, const Pixel* below, int width,
                                   LaplacianOf<Pixel>* out) noexcept {
  for (int x = 0; x < width; ++x) {
    const int left = row[std::max(x - 1, 0)];
    const int right = row[std::min(x + 1, width - 1)];
    out[x] = laplacian<Pixel>(left, right, above[x], below[x], row[x]);
  }
}

template <typename Pixel>
void modified_laplacian_row(const Pixel* above, const Pixel* row, const Pixel* below, int width,
                            LaplacianOf<Pixel>* out) noexcept {
  const int last = width - 1;
  const int inner = std::min(1, last);
  out[0] = laplacian<Pixel>(row[0], row[inner], above[0], below[0], row[0]);
  interior_row(above, row, below, width, out);
  if (last > 0) out[last] = laplacian<Pixel>(row[last - 1], row[last], above[last], below[last], row[last]);
}

template void modified_laplacian_row_scalar(const std::uint8_t*, const std::uint8_t*, const std::uint8_t*, int,
                                            std::uint16_t*) noexcept;
template void modified_laplacian_row_scalar(const std::uint16_t*, const std::uint16_t*, const std::uint16_t*, int,
                                            std::uint32_t*) noexcept;
template void modified_laplacian_row(const std::uint8_t*, const std::uint8_t*, const std::uint8_t*, int,
                                     std::uint16_t*) noexcept;
template void modified_laplacian_row(const std::uint16_t*, const std::uint16_t*, const std::uint16_t*, int,
                                     std::uint32_t*) noexcept;

}  // namespace fvd
