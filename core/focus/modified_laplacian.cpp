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
                                                    const Pixel* __restrict below, int width, int distance,
                                                    LaplacianOf<Pixel>* __restrict out) {
  for (int x = distance; x < width - distance; ++x) {
    const auto twice = static_cast<Wide>(2 * row[x]);
    const auto horizontal = static_cast<Wide>(twice - row[x - distance] - row[x + distance]);
    const auto vertical = static_cast<Wide>(twice - above[x] - below[x]);
    out[x] = static_cast<LaplacianOf<Pixel>>((horizontal < 0 ? -horizontal : horizontal) +
                                             (vertical < 0 ? -vertical : vertical));
  }
}

// Clones need a plain function each. 8 bit: the differences lie within -510..510, so 16-bit lanes do.
FVD_VECTOR_CLONES void interior_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                                    int width, int distance, std::uint16_t* out) {
  interior<std::uint8_t, std::int16_t>(above, row, below, width, distance, out);
}
FVD_VECTOR_CLONES void interior_row(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                                    int width, int distance, std::uint32_t* out) {
  interior<std::uint16_t, std::int32_t>(above, row, below, width, distance, out);
}

/// One pixel anywhere: neighbours beyond the border are the border's pixel.
template <typename Pixel>
LaplacianOf<Pixel> at(const Pixel* above, const Pixel* row, const Pixel* below, int x, int width, int distance) {
  return laplacian<Pixel>(row[std::max(x - distance, 0)], row[std::min(x + distance, width - 1)], above[x], below[x],
                          row[x]);
}

}  // namespace

template <typename Pixel>
void modified_laplacian_row_scalar(const Pixel* above, const Pixel* row, const Pixel* below, int width, int distance,
                                   LaplacianOf<Pixel>* out) noexcept {
  for (int x = 0; x < width; ++x) out[x] = at(above, row, below, x, width, distance);
}

template <typename Pixel>
void modified_laplacian_row(const Pixel* above, const Pixel* row, const Pixel* below, int width, int distance,
                            LaplacianOf<Pixel>* out) noexcept {
  const int left_end = std::min(distance, width);
  const int right_begin = std::max(left_end, width - distance);
  for (int x = 0; x < left_end; ++x) out[x] = at(above, row, below, x, width, distance);
  interior_row(above, row, below, width, distance, out);
  for (int x = right_begin; x < width; ++x) out[x] = at(above, row, below, x, width, distance);
}

template void modified_laplacian_row_scalar(const std::uint8_t*, const std::uint8_t*, const std::uint8_t*, int, int,
                                            std::uint16_t*) noexcept;
template void modified_laplacian_row_scalar(const std::uint16_t*, const std::uint16_t*, const std::uint16_t*, int, int,
                                            std::uint32_t*) noexcept;
template void modified_laplacian_row(const std::uint8_t*, const std::uint8_t*, const std::uint8_t*, int, int,
                                     std::uint16_t*) noexcept;
template void modified_laplacian_row(const std::uint16_t*, const std::uint16_t*, const std::uint16_t*, int, int,
                                     std::uint32_t*) noexcept;

}  // namespace fvd
