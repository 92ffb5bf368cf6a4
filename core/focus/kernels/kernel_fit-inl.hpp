#pragma once

// From condensed curves to heights.
//
// In: a row of the curves' state, the table of heights by sample number, the noise. Out: height, variance, prominence,
// mask of each point. The formula is in five_sample_fit.hpp; here its sums, Cramer's rule and their derivatives are
// spread over short loops, see kFitPixels, each of which does one stage for all the pixels.

#include "core/focus/kernels/focus_kernels_common.hpp"
#include "core/focus/kernels/kernel_fit_sums-inl.hpp"
#include "core/focus/kernels/kernel_vectors-inl.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

/// Number of pixels that the fit processes together, in short loops one after the other: one long loop would wait for
/// its own divisions and roots; of short ones the processor has several iterations under way. The intermediate values
/// stay in the nearest cache and are all 32 bits wide: in a loop that also loads 8 and 16 bits, g++ processes as many
/// pixels together as fill a register with the narrowest type, and spills.
constexpr int kFitPixels = 64;
using FitFloats = float[kFitPixels];
using FitFlags = std::int32_t[kFitPixels];

/// Per neighbour of the peak: two before it, two after.
struct FitNeighbours {
  FitFloats left2;
  FitFloats left;
  FitFloats right;
  FitFloats right2;
};

/// Intermediate values of the pixels; filled from top to bottom.
struct FitPixels {
  FitFloats peak;  // codes or, where these are roots, their squares
  FitFloats minimum;
  FitNeighbours codes;
  FitFloats z_um;  // and what else the table says
  FitFloats scale_um;
  FitNeighbours u;
  FitFlags known;  // the mask before the fit
  FitFloats least_neighbours;
  FitFlags clipped;   // what is known of the peak, see clipping
  FitFlags narrow;    // whether the neighbours are too low
  FitFloats inverse;  // of the amplitude
  FitNeighbours r;    // shares of the amplitude; after the sums to the power of 5
  FitFloats s0;       // sums over the samples of w u^n, w = r^4
  FitFloats s1;
  FitFloats s2;
  FitFloats s3;
  FitFloats s4;
  FitFloats t0;  // and of w u^n r^-1/2
  FitFloats t1;
  FitFloats t2;
  FitFloats vertex;  // in u
  FitFloats l0;      // the vertex' derivatives by t0, t1, t2
  FitFloats l1;
  FitFloats l2;
  FitFloats bend;  // b / (1 + 0.9 b), b the curvature in u
  FitFlags peaked;
  FitFlags mask;
};

template <bool kRoot>
inline void decode(const std::uint16_t* codes, int count, float* values) {
  for (int x = 0; x < count; ++x) {
    const auto value = static_cast<float>(codes[x]);
    values[x] = kRoot ? value * value : value;
  }
}

template <bool kRoot>
inline void decode(const CurveRow& row, int first, int count, FitPixels& at) {
  decode<kRoot>(row.peak + first, count, at.peak);
  decode<kRoot>(row.minimum + first, count, at.minimum);
  decode<kRoot>(row.left2 + first, count, at.codes.left2);
  decode<kRoot>(row.left + first, count, at.codes.left);
  decode<kRoot>(row.right + first, count, at.codes.right);
  decode<kRoot>(row.right2 + first, count, at.codes.right2);
}

/// Loads the entries of 4 pixels, x to x + 3.
inline __attribute__((always_inline)) void look_up_four(const std::uint16_t* indices, HeightTable table, int x,
                                                        FitPixels& at) {
  const auto* const e0 = &table[indices[x]].z_um;
  const auto* const e1 = &table[indices[x + 1]].z_um;
  const auto* const e2 = &table[indices[x + 2]].z_um;
  const auto* const e3 = &table[indices[x + 3]].z_um;
  transpose(e0, e1, e2, e3, at.z_um + x, at.scale_um + x, at.u.left2 + x, at.u.left + x);
  transpose(e0 + 4, e1 + 4, e2 + 4, e3 + 4, at.u.right + x, at.u.right2 + x, reinterpret_cast<float*>(at.known + x),
            at.least_neighbours + x);
}

using Eight = float __attribute__((vector_size(32), may_alias));
using EightFlags = std::int32_t __attribute__((vector_size(32), may_alias));

/// Loads one entry for 8 pixels, x to x + 7. Subtracting a zero leaves every value unchanged; g++ makes a broadcast of
/// it.
inline __attribute__((always_inline)) void look_up_once(const HeightEntry& entry, int x, FitPixels& at) {
  const Eight z_um = entry.z_um - Eight{};
  const Eight scale_um = entry.scale_um - Eight{};
  const Eight left2 = entry.u_left2 - Eight{};
  const Eight left = entry.u_left - Eight{};
  const Eight right = entry.u_right - Eight{};
  const Eight right2 = entry.u_right2 - Eight{};
  const EightFlags known = entry.mask - EightFlags{};
  const Eight least_neighbours = entry.least_neighbours - Eight{};
  store(z_um, at.z_um + x);
  store(scale_um, at.scale_um + x);
  store(left2, at.u.left2 + x);
  store(left, at.u.left + x);
  store(right, at.u.right + x);
  store(right2, at.u.right2 + x);
  store(known, at.known + x);
  store(least_neighbours, at.least_neighbours + x);
}

/// On most surfaces neighbours peak in the same slice; one entry is then loaded for all of them.
inline void look_up(const std::uint16_t* indices, HeightTable table, int count, FitPixels& at) {
  int x = 0;
  for (; x + 8 <= count; x += 8) {
    std::uint64_t four[2];
    __builtin_memcpy(four, indices + x, sizeof four);
    constexpr std::uint64_t kFourCopies = 0x0001000100010001;
    if (four[0] == four[1] && four[0] == kFourCopies * indices[x]) {
      look_up_once(table[indices[x]], x, at);
    } else {
      look_up_four(indices, table, x, at);
      look_up_four(indices, table, x + 4, at);
    }
  }
  for (; x < count; ++x) {
    const HeightEntry& entry = table[indices[x]];
    at.z_um[x] = entry.z_um;
    at.scale_um[x] = entry.scale_um;
    at.u.left2[x] = entry.u_left2;
    at.u.left[x] = entry.u_left;
    at.u.right[x] = entry.u_right;
    at.u.right2[x] = entry.u_right2;
    at.known[x] = entry.mask;
    at.least_neighbours[x] = entry.least_neighbours;
  }
}

inline void find_shares(int count, const FitParameters& parameters, FitPixels& at) {
  const float least_shoulder = parameters.least_shoulder;
  const float most_neighbours = parameters.most_neighbours;
  FVD_NO_ALIASING
  for (int x = 0; x < count; ++x) {
    const float floor = kFloorShare * at.minimum[x];
    const float amplitude = at.peak[x] - floor;
    const float inverse = 1.0F / (amplitude > 0.0F ? amplitude : 1.0F);
    at.inverse[x] = inverse;
    const auto share = [&](float value) {
      const float r = (value - floor) * inverse;
      return r > kSmallestShare ? r : kSmallestShare;
    };
    const float left = share(at.codes.left[x]);
    const float right = share(at.codes.right[x]);
    // A sample that is not there has no weight.
    const float left2 = at.u.left2[x] != 0.0F ? share(at.codes.left2[x]) : 0.0F;
    const float right2 = at.u.right2[x] != 0.0F ? share(at.codes.right2[x]) : 0.0F;
    at.r.left[x] = left;
    at.r.right[x] = right;
    at.r.left2[x] = left2;
    at.r.right2[x] = right2;
    const float near = left + right;
    const float lower = left < right ? left : right;
    // Without one of the samples two away the other stands for both.
    const float far = (at.u.left2[x] != 0.0F ? left2 : right2) + (at.u.right2[x] != 0.0F ? right2 : left2);
    const float sum = at.u.left[x] + at.u.right[x];
    const float least = sum * sum > kUneven * kUneven ? kUnevenShoulder * least_shoulder : least_shoulder;
    at.narrow[x] = static_cast<std::int32_t>(near < at.least_neighbours[x]) |
                   static_cast<std::int32_t>(lower < kLowerNeighbour * at.least_neighbours[x]) |
                   (static_cast<std::int32_t>(near - far < least * (2.0F - near)) &
                    static_cast<std::int32_t>(near < most_neighbours));
  }
}

template <bool kLogarithm>
inline void add_samples(int count, FitPixels& at) {
  FVD_NO_ALIASING
  for (int x = 0; x < count; ++x) {
    FitSums sums;
    if (kLogarithm) sums.t0 = 0.0F;  // the peak's own, ln 1
    at.r.left2[x] = add<kLogarithm>(sums, at.r.left2[x], at.u.left2[x]);
    at.r.left[x] = add<kLogarithm>(sums, at.r.left[x], at.u.left[x]);
    at.r.right[x] = add<kLogarithm>(sums, at.r.right[x], at.u.right[x]);
    at.r.right2[x] = add<kLogarithm>(sums, at.r.right2[x], at.u.right2[x]);
    at.s0[x] = sums.s0;
    at.s1[x] = sums.s1;
    at.s2[x] = sums.s2;
    at.s3[x] = sums.s3;
    at.s4[x] = sums.s4;
    at.t0[x] = sums.t0;
    at.t1[x] = sums.t1;
    at.t2[x] = sums.t2;
  }
}

inline void solve(int count, FitPixels& at) {
  FVD_NO_ALIASING
  for (int x = 0; x < count; ++x) {
    const float s0 = at.s0[x];
    const float s1 = at.s1[x];
    const float s2 = at.s2[x];
    const float s3 = at.s3[x];
    const float s4 = at.s4[x];
    // Cramer's rule for k1, k2 of g = k0 + k1 u + k2 u^2; c.. are the cofactors of their rows.
    const float c10 = s2 * s3 - s1 * s4;
    const float c11 = s0 * s4 - s2 * s2;
    const float c12 = s1 * s2 - s0 * s3;
    const float c20 = s1 * s3 - s2 * s2;
    const float c22 = s0 * s2 - s1 * s1;
    const float k1 = c10 * at.t0[x] + c11 * at.t1[x] + c12 * at.t2[x];
    const float k2 = c20 * at.t0[x] + c12 * at.t1[x] + c22 * at.t2[x];
    // Both lack the same positive factor, the determinant, which cancels in their ratio.
    const float determinant = s1 * c10 + s2 * c11 + s3 * c12;
    const std::int32_t convex = static_cast<std::int32_t>(k2 > 0.0F) & static_cast<std::int32_t>(determinant > 0.0F);
    const float curvature = convex != 0 ? k2 : 1.0F;
    // u = a k1, and du = a dk1 + b dk2 with the determinant back in.
    const float a = -0.5F / curvature;
    const float u = a * k1;
    const float b = 2.0F * a * u;
    // A vertex beyond the neighbours is not the peak that was sampled.
    at.peaked[x] = convex & static_cast<std::int32_t>((u - at.u.left[x]) * (u - at.u.right[x]) <= 0.0F);
    at.vertex[x] = u;
    at.l0[x] = a * c10 + b * c20;
    at.l1[x] = a * c11 + b * c12;
    at.l2[x] = a * c12 + b * c22;
    // The curvature is k2 over the determinant; what is not convex is a hole.
    at.bend[x] = curvature / ((determinant > 0.0F ? determinant : 1.0F) + 0.9F * curvature);
  }
}

inline float share_unit(const FitParameters& parameters) {
  return parameters.root_code ? parameters.code_unit * parameters.code_unit : parameters.code_unit;
}

/// The share of the variance of a sample of weight r^4 that reaches the vertex, times 4: dg = r^-3/2 dr / 2. With
/// logarithms, of weight r^2 and not times 4: dg = dr / r, and r^2 in the place of r^5.
inline __attribute__((always_inline)) float gain(float r5, float u, float l0, float l1, float l2) {
  const float lever = l0 + (l1 + l2 * u) * u;
  return r5 * lever * lever;
}

/// Fills at.mask.
inline void judge(int count, const float* noise, const float* least, const FitParameters& parameters, FitPixels& at,
                  float* prominences) {
  const float min_prominence = parameters.min_prominence;
  const float min_significance = parameters.min_significance;
  const float unit = share_unit(parameters);
  const float least_bend = parameters.least_bend_per_um2;
  FVD_NO_ALIASING
  for (int x = 0; x < count; ++x) {
    const float top = at.peak[x];
    const float rise = top - at.minimum[x];
    const float prominence = rise / (top > 0.0F ? top : 1.0F);
    const float share = rise * unit;
    const std::int32_t known = at.known[x];
    constexpr std::int32_t kEnds = mask_reason::kFirstSlice | mask_reason::kLastSlice;
    const std::int32_t flat =
        static_cast<std::int32_t>(prominence < min_prominence) | static_cast<std::int32_t>(top == 0.0F);
    const auto weak = static_cast<std::int32_t>(share < min_significance * noise[x]);
    const auto bled = static_cast<std::int32_t>(share < least[x]);
    const std::int32_t open = static_cast<std::int32_t>((known & kEnds) == 0) & (at.peaked[x] ^ 1);
    const float bend = at.bend[x];
    const float scale_um = at.scale_um[x];
    const std::int32_t fitted = static_cast<std::int32_t>(known == 0) & at.peaked[x];
    const std::int32_t broad =
        fitted & static_cast<std::int32_t>(at.clipped[x] == 0) &  // clipping flattens a curve's top
        static_cast<std::int32_t>(bend < least_bend * (scale_um * scale_um) * (1.0F - 0.9F * bend));
    at.mask[x] = known | (-flat & mask_reason::kLowProminence) | (-weak & mask_reason::kInsignificant) |
                 (-bled & mask_reason::kEdgeBleeding) | (-open & mask_reason::kNotBracketed) |
                 (-broad & mask_reason::kBroadCurve) | (-(at.narrow[x] & fitted) & mask_reason::kNarrowCurve);
    prominences[x] = prominence;
  }
}

inline void find_heights(int count, const float* noise, const FitParameters& parameters, const FitPixels& at,
                         float* height_m, float* variance_m2) {
  const float shape_error = parameters.shape_error;
  const VertexBias bias = parameters.bias;
  const float derivative = parameters.logarithm ? 1.0F : 0.5F;  // of G by a share, near the peak
  const float misfit = derivative * derivative * parameters.misfit * parameters.misfit;
  const float g_per_unit = derivative / share_unit(parameters);
  FVD_NO_ALIASING
  for (int x = 0; x < count; ++x) {
    const float l0 = at.l0[x];
    const float l1 = at.l1[x];
    const float l2 = at.l2[x];
    const float variance =
        l0 * l0 + gain(at.r.left[x], at.u.left[x], l0, l1, l2) + gain(at.r.left2[x], at.u.left2[x], l0, l1, l2) +
        gain(at.r.right[x], at.u.right[x], l0, l1, l2) + gain(at.r.right2[x], at.u.right2[x], l0, l1, l2);
    const float relative_noise = noise[x] * g_per_unit * at.inverse[x];
    const float bend = at.bend[x];
    const float shape = shape_error * bend;
    const float scale_m = at.scale_um[x] * 1e-6F;
    const float u = at.vertex[x];
    const float below = u < 0.5F ? u : 0.5F;  // the bias is known to half a step
    const float near = below > -0.5F ? below : -0.5F;
    // From there it goes to nothing at the neighbours: no vertex is taken beyond them.
    const float inside = (u - at.u.left[x]) * (at.u.right[x] - u) * (4.0F / 3.0F);
    const float share = inside < 1.0F ? inside : 1.0F;
    const float vertex = u - (bias.linear + bias.cubic * near * near) * near * bend * share;
    const bool valid = at.mask[x] == 0;
    const float spread = (variance * (relative_noise * relative_noise + misfit) + shape * shape) * (scale_m * scale_m);
    const float height = (at.z_um[x] + vertex * at.scale_um[x]) * 1e-6F;
    variance_m2[x] = valid ? spread : kNaN;
    height_m[x] = valid ? height : kNaN;
  }
}

/// Returns whether any window was clipped.
inline bool mark_clipped(const std::uint8_t* state, int count, FitPixels& at) {
  std::uint8_t any = 0;
  for (int x = 0; x < count; ++x) any = static_cast<std::uint8_t>(any | (state[x] & clipping::kPeakBits));
  for (int x = 0; x < count; ++x) at.clipped[x] = 0;
  if (any == 0) return false;  // nearly always
  for (int x = 0; x < count; ++x) {
    const int peak = state[x] & clipping::kPeakBits;
    const std::int32_t lost = peak == clipping::kNoPeak ? 1 : 0;
    at.known[x] |= -lost & mask_reason::kSaturated;
    at.clipped[x] = peak;
  }
  return true;
}

inline void widen_variance(int count, const FitPixels& at, float* variance_m2) {
  for (int x = 0; x < count; ++x) {
    const float many = at.clipped[x] == clipping::kMany ? clipping::kManyVariance : clipping::kSomeVariance;
    variance_m2[x] *= at.clipped[x] == 0 ? 1.0F : many;
  }
}

/// The next row's part below these pixels.
inline __attribute__((always_inline)) void fetch_below(const CurveRow& row, const FitRow& out, int width, int first) {
  for (const std::uint16_t* field :
       {row.peak, row.left, row.left2, row.right, row.right2, row.minimum, row.peak_index}) {
    fetch<2 * kFitPixels>(field + first, row.pitch_bytes, false);
  }
  fetch<kFitPixels>(row.clipped + first, row.pitch_bytes, false);
  for (const float* plane : {out.height_m, out.variance_m2, out.prominence}) {
    fetch<4 * kFitPixels>(plane + first, std::ptrdiff_t{4} * width, true);
  }
  fetch<2 * kFitPixels>(out.mask + first, std::ptrdiff_t{2} * width, true);
}

void fit_five(const CurveRow& row, HeightTable table, const float* noise, const float* least_amplitude, int width,
              const FitParameters& parameters, const FitRow& out) noexcept {
  FitPixels at;
  for (int first = 0; first < width; first += kFitPixels) {
    const int count = width - first < kFitPixels ? width - first : kFitPixels;
    if (parameters.root_code) {
      decode<true>(row, first, count, at);
    } else {
      decode<false>(row, first, count, at);
    }
    fetch_below(row, out, width, first);
    look_up(row.peak_index + first, table, count, at);
    const bool clipped = mark_clipped(row.clipped + first, count, at);
    find_shares(count, parameters, at);
    if (parameters.logarithm) {
      add_samples<true>(count, at);
    } else {
      add_samples<false>(count, at);
    }
    solve(count, at);
    judge(count, noise + first, least_amplitude + first, parameters, at, out.prominence + first);
    find_heights(count, noise + first, parameters, at, out.height_m + first, out.variance_m2 + first);
    if (clipped) widen_variance(count, at, out.variance_m2 + first);
    auto* const mask = out.mask + first;
    for (int x = 0; x < count; ++x) mask[x] = static_cast<MaskReasons>(at.mask[x]);
  }
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
