#pragma once

/// The loops in which a scan spends its time, once for every kind of processor, chosen when the program starts.
///
/// One source, focus_kernels-inl.hpp, is compiled four times: without vector code ("scalar"), for the processor every
/// build may assume ("baseline"), for AVX2 and for AVX-512. All give the same bits; the tests compare them with each
/// other. The environment variable FVD_FORCE_KERNEL names the one to use.
///
/// Rows have shape [width] unless said otherwise, width >= 1; outputs do not overlap inputs. context: thread-safe.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/surface/mask_reason.hpp"

namespace fvd {

/// How much of a window is clipped, and what that says of a peak.
///
/// Level of a sample: 0 nothing, 1 .. 62 that many 62nds of the window's area, rounded up, 63 more than the settings
/// allow. In the state, the last sample's level shares a byte with what is known of the peak. A surface's clipped share
/// is least where it is in focus, or nearly so: where it grows by more than three levels beside the peak, or grows on
/// one side and falls on the other, the peak is the rim of a blurred glint.
namespace clipping {
inline constexpr std::uint8_t kMostLevel = 62;
inline constexpr std::uint8_t kTooMuch = 63;
inline constexpr std::uint8_t kMostGrowth = 3;  ///< levels from the peak to the sample beside it
inline constexpr std::uint8_t kManyLevel = 22;  ///< from here on the height is less certain by a fifth
inline constexpr std::uint8_t kLevelBits = 63;
inline constexpr std::uint8_t kPeakBits = 0xC0;
/// Of the peak's window. No peak: too much, or the share grows from it.
inline constexpr std::uint8_t kSome = 0x40;
inline constexpr std::uint8_t kMany = 0x80;
inline constexpr std::uint8_t kNoPeak = 0xC0;
/// While the sample after the peak is not known: whether the one before has a lower or a higher level, or it is
/// kNoPeak.
inline constexpr std::uint8_t kRose = 0x40;
inline constexpr std::uint8_t kFell = 0x80;
inline constexpr float kSomeVariance = 1.1F;  ///< what the variance is multiplied with
inline constexpr float kManyVariance = 1.4F;
}  // namespace clipping

/// What is known of a curve's second peak, one 16-bit code.
///
/// The second peak is the highest sample that lies at least four samples from the peak and is parted from it by a
/// valley, a sample between them below a share of the peak: without one it is the peak's own flank. While the curve
/// grows, a peak that is overtaken becomes the second peak if the valley and the four samples lie before the sample
/// that overtakes it. The lowest bit of the code says whether the valley has been seen since the peak; it is no part of
/// the sharpness.
namespace second_peak {
inline constexpr std::uint16_t kDistance = 4;  ///< samples
inline constexpr std::uint16_t kValleyBit = 1;
/// Sample below which a curve with this peak is in a valley. share: in 65536ths.
[[nodiscard]] constexpr std::uint16_t valley(std::uint16_t peak, std::uint16_t share) noexcept {
  return static_cast<std::uint16_t>((static_cast<std::uint32_t>(peak) * share) >> 16U);
}
/// The sharpness of a code.
[[nodiscard]] constexpr std::uint16_t sharpness(std::uint16_t code) noexcept {
  return static_cast<std::uint16_t>(code & ~std::uint32_t{kValleyBit});
}
}  // namespace second_peak

/// The state of one row of focus curves, one array per field, shape [width]. Sharpness is in codes, see
/// sharpness_code.hpp.
struct CurveRow {
  std::uint16_t* previous;          ///< the sample before
  std::uint16_t* previous2;         ///< the sample before `previous`
  std::uint16_t* peak;              ///< largest so far; of equal ones the first
  std::uint16_t* left;              ///< the sample before the peak, 0 where there is none
  std::uint16_t* left2;             ///< the sample before `left`
  std::uint16_t* right;             ///< the sample after the peak, 0 while there is none
  std::uint16_t* right2;            ///< the sample after `right`
  std::uint16_t* minimum;           ///< smallest so far
  std::uint16_t* peak_index;        ///< number of the peak's sample, 0-based
  std::uint8_t* clipped;            ///< see clipping
  std::ptrdiff_t pitch_bytes = 0;   ///< from each field to the same field of the next row; 0 = unknown
  std::uint16_t* second = nullptr;  ///< see second_peak; nullptr = not looked for
  std::uint16_t valley_share = 0;   ///< of the codes, in 65536ths, see second_peak
};

/// A row of one sample. Texture: std::uint8_t or std::uint16_t.
template <typename Texture>
struct Sample {
  const std::uint16_t* codes;
  const std::uint8_t* clipped;  ///< levels, see clipping; nullptr = all are 0
  const Texture* pixels;
};

/// The heights of a sample and its neighbours; one entry per sample. u = (z - z of the sample) / scale.
struct alignas(32) HeightEntry {
  float z_um = 0.0F;
  float scale_um = 1.0F;  ///< mean distance to the neighbours
  float u_left2 = 0.0F;   ///< 0 where there is no such sample, or its z does not run on
  float u_left = 0.0F;
  float u_right = 0.0F;
  float u_right2 = 0.0F;
  std::int32_t mask = 0;          ///< mask_reason bits that follow from the number alone
  float least_neighbours = 0.0F;  ///< sum of both neighbours' shares of the peak below which a curve is too narrow
};
using HeightTable = std::span<const HeightEntry>;

/// Error of a fit's vertex, see curve_shape.hpp: (linear u + cubic u^3) b / (1 + 0.9 b) sample distances, u the
/// position of the vertex, b the curvature of the fit.
struct VertexBias {
  float linear = 0.0F;
  float cubic = 0.0F;
};

/// Parameters of a fit that are the same for all curves.
struct FitParameters {
  float min_prominence;
  float min_significance;
  float shape_error;  ///< see five_sample_fit.hpp
  float misfit;       ///< standard deviation of a sample beside its noise, as a share of the amplitude
  float code_unit;    ///< a code times this is a share of full scale, or its root; see sharpness_code.hpp
  bool root_code;
  VertexBias bias;                  ///< to be subtracted from the vertex
  float least_bend_per_um2 = 0.0F;  ///< curvature of G, see five_sample_fit.hpp, below which a curve is too broad
  float least_shoulder = -1e30F;    ///< see curve_limits.hpp; below it a curve is too narrow
  float most_neighbours = 0.0F;     ///< where both neighbours' shares add up to less than this
  bool logarithm = false;           ///< the other form of the fit, see five_sample_fit.hpp
};

/// Output of the fits: rows of planes without padding; NaN in height and variance exactly where mask is not 0.
struct FitRow {
  float* height_m;
  float* variance_m2;  ///< of the height
  float* prominence;
  MaskReasons* mask;
};

/// A row of pixels and those around it that the diagonals reach.
template <typename Pixel>
struct DiagonalRows {
  const Pixel* above;  ///< `distance` above
  const Pixel* upper;  ///< `inner` above
  const Pixel* row;
  const Pixel* lower;  ///< `inner` below
  const Pixel* below;  ///< `distance` below
  int distance;        ///< px
  int inner;           ///< px, the diagonals' first step, 1..distance
};

struct FocusKernels {
  std::string_view name;

  /// Modified Laplacian >> shift of the row, from the rows `distance` above and below; columns within `distance` of an
  /// end are left unchanged.
  void (*laplacian_u16)(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below, int width,
                        int distance, int shift, std::uint32_t* out) noexcept;
  /// The diagonal Laplacian >> shift, see sharpness_rows.hpp; ends as for the Laplacian.
  void (*diagonal_u8)(const DiagonalRows<std::uint8_t>& rows, int width, int shift, std::uint32_t* out) noexcept;
  void (*diagonal_u16)(const DiagonalRows<std::uint16_t>& rows, int width, int shift, std::uint32_t* out) noexcept;
  /// (gx^2 + gy^2) >> shift of the Sobel gradients; ends as for the Laplacian.
  void (*tenengrad_u8)(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                       int distance, int shift, std::uint32_t* out) noexcept;
  void (*tenengrad_u16)(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below, int width,
                        int distance, int shift, std::uint32_t* out) noexcept;

  /// Modified or diagonal Laplacian of an 8-bit row in one pass with the sums over the window's rows that it enters:
  /// columns += value - slot; slot = value; scaled = columns / 2^shift, rounded. Ends as for the Laplacian.
  void (*enter_laplacian_u8)(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                             int distance, int shift, std::uint16_t* columns, std::uint16_t* slot,
                             std::uint16_t* scaled) noexcept;
  void (*enter_diagonal_u8)(const DiagonalRows<std::uint8_t>& rows, int width, int shift, std::uint16_t* columns,
                            std::uint16_t* slot, std::uint16_t* scaled) noexcept;
  /// columns += entering - leaving; leaving = entering; of 16 bit: scaled = columns / 2^shift, rounded.
  void (*slide_u16)(std::uint16_t* columns, const std::uint16_t* entering, std::uint16_t* leaving, int width, int shift,
                    std::uint16_t* scaled) noexcept;
  void (*slide_u32)(std::uint32_t* columns, const std::uint32_t* entering, std::uint32_t* leaving, int width) noexcept;
  /// out[x] = values[x] + .. + values[x + window - 1] for x = 0 .. width - window. window: 3 .. 63.
  void (*window_sums_u16)(const std::uint16_t* values, int window, int width, std::uint16_t* out) noexcept;
  void (*window_sums_u32)(const std::uint32_t* values, int window, int width, std::uint32_t* out) noexcept;
  /// values /= 2^shift, rounded. shift >= 1.
  void (*scale_u16)(std::uint16_t* values, int shift, int width) noexcept;
  /// out = round(gain * sqrt(sums)); sums < 2^31.
  void (*root_code)(const std::uint32_t* sums, float gain, int width, std::uint16_t* out) noexcept;

  std::uint8_t (*maximum_u8)(const std::uint8_t* row, int width) noexcept;
  std::uint16_t (*maximum_u16)(const std::uint16_t* row, int width) noexcept;

  /// sums += codes / 2^shift, rounded.
  void (*add_to_bin)(std::uint16_t* sums, const std::uint16_t* codes, int shift, int width) noexcept;

  /// out = values. The next row of values lies pitch_bytes behind `values`, that of out `width` elements behind `out`.
  void (*widen_u8)(const std::uint8_t* values, std::ptrdiff_t pitch_bytes, int width, std::uint16_t* out) noexcept;

  /// Takes successive samples in; the number of the first is first_index >= 1. texture keeps the pixel of the peak's
  /// sample. The rows of the state and of texture have room for width rounded up to 16.
  void (*update_u8)(const CurveRow& row, const Sample<std::uint8_t>* samples, int count, std::uint8_t* texture,
                    int width, int first_index) noexcept;
  void (*update_u16)(const CurveRow& row, const Sample<std::uint16_t>* samples, int count, std::uint16_t* texture,
                     int width, int first_index) noexcept;

  /// Sum of |I(-1,-1) - 2 I(0,-1) + I(1,-1) - 2 (..) + ..| over x = 1 .. width - 2 (Immerkaer, CVIU 64(2), 1996).
  std::uint64_t (*noise_u8)(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                            int width) noexcept;
  std::uint64_t (*noise_u16)(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                             int width) noexcept;

  /// The five-sample fit, see five_sample_fit.hpp. noise: standard deviation of a sample, least_amplitude: of peak less
  /// minimum, below which a point is edge bleeding; both as shares of full scale.
  void (*fit_five)(const CurveRow& row, HeightTable table, const float* noise, const float* least_amplitude, int width,
                   const FitParameters& parameters, const FitRow& out) noexcept;
  /// highest = max(highest, peak less minimum), both codes squared first where they are roots. 0 <= minimum <= peak.
  void (*raise_amplitudes)(const std::uint16_t* peak, const std::uint16_t* minimum, bool root_code, int width,
                           std::uint32_t* highest) noexcept;
  /// Whether any two of a and b differ by more than `most` and neither is insignificant.
  bool (*any_apart)(const std::uint16_t* a, const std::uint16_t* b, const MaskReasons* mask_a,
                    const MaskReasons* mask_b, int width, std::uint16_t most) noexcept;
  /// In place, sigma = sqrt(variance + (factor * gradient)^2). The gradient comes from the heights `reach` to either
  /// side; a component with a missing height is 0. upper, lower: rows of heights `reach` above and below. sigma =
  /// sqrt(variance) if they are nullptr, and for columns within `reach` of an end.
  void (*finish_sigma)(const float* height, const float* upper, const float* lower, int reach, float factor, int width,
                       float* sigma) noexcept;
};

/// The fastest kernels that this processor runs, or those that FVD_FORCE_KERNEL names. Throws Error kBadInput for an
/// unknown name, and for kernels that this processor cannot run.
[[nodiscard]] const FocusKernels& focus_kernels();

/// All kernels that this processor runs, slowest first.
[[nodiscard]] std::span<const FocusKernels* const> all_focus_kernels() noexcept;

}  // namespace fvd
