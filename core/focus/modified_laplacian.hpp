#pragma once

/// The modified Laplacian of Nayar and Nakagawa (IEEE PAMI 16(8), 1994) with their variable spacing of d pixels:
///
///   ML(x,y) = |2 I(x,y) - I(x-d,y) - I(x+d,y)| + |2 I(x,y) - I(x,y-d) - I(x,y+d)|
///
/// The absolute values are summed so that curvatures of opposite sign do not cancel. Outside the image the edge pixel
/// is repeated. On an oversampled image neighbours differ by noise more than by texture: d matches the texture. 8 bit:
/// <= 4 * 255 = 1020, fits uint16. 16 bit: <= 4 * 65535 = 262140, needs uint32.

#include <cstdint>
#include <type_traits>

namespace fvd {

template <typename Pixel>
using LaplacianOf = std::conditional_t<sizeof(Pixel) == 1, std::uint16_t, std::uint32_t>;

/// One row of shape [width] from the row itself and the rows `distance` pixels above and below; width, distance >= 1.
/// `out` does not overlap the inputs. Plain loop, the law for modified_laplacian_row.
template <typename Pixel>
void modified_laplacian_row_scalar(const Pixel* above, const Pixel* row, const Pixel* below, int width, int distance,
                                   LaplacianOf<Pixel>* out) noexcept;

/// The same, in the shape compilers turn into vector code. Bit for bit equal.
template <typename Pixel>
void modified_laplacian_row(const Pixel* above, const Pixel* row, const Pixel* below, int width, int distance,
                            LaplacianOf<Pixel>* out) noexcept;

}  // namespace fvd
