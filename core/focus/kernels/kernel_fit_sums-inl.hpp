#pragma once

// What the five samples of a curve add to the fit's normal equations, in both forms of five_sample_fit.hpp.

#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

/// Over the peak and its neighbours.
struct FitSums {
  float s0 = 1.0F;  // the peak itself: weight 1 at u = 0, r = 1
  float s1 = 0.0F;
  float s2 = 0.0F;
  float s3 = 0.0F;
  float s4 = 0.0F;
  float t0 = 1.0F;
  float t1 = 0.0F;
  float t2 = 0.0F;
};

/// v: w times the sample's G.
inline __attribute__((always_inline)) void add_terms(FitSums& sums, float w, float v, float u) {
  const float wu = w * u;
  const float wu2 = wu * u;
  const float wu3 = wu2 * u;
  const float vu = v * u;
  sums.s0 += w;
  sums.s1 += wu;
  sums.s2 += wu2;
  sums.s3 += wu3;
  sums.s4 += wu3 * u;
  sums.t0 += v;
  sums.t1 += vu;
  sums.t2 += vu * u;
}

/// By the series of the inverse hyperbolic tangent, ln m = 2 artanh((m - 1) / (m + 1)), of which five terms are a
/// float's last digit between 2/3 and 4/3; not the C library's, which may differ between processors. value > 0, no
/// denormal.
inline __attribute__((always_inline)) float natural_logarithm(float value) {
  constexpr std::int32_t kTwoThirds = 0x3F2AAAAB;
  const auto bits = __builtin_bit_cast(std::int32_t, value);
  const std::int32_t exponent = (bits - kTwoThirds) >> 23;
  const auto m = __builtin_bit_cast(float, bits - exponent * (1 << 23));
  const float t = (m - 1.0F) / (m + 1.0F);
  const float t2 = t * t;
  const float series = 1.0F + t2 * (1.0F / 3.0F + t2 * (1.0F / 5.0F + t2 * (1.0F / 7.0F + t2 * (1.0F / 9.0F))));
  return 2.0F * t * series + 0.693147181F * static_cast<float>(exponent);
}

/// Of the fit of a curve without heavy tails: w = r^2 and -ln r. Returns r^2.
inline __attribute__((always_inline)) float add_logarithm(FitSums& sums, float r, float u) {
  const float w = r * r;  // 0 of a sample that is not there
  const float v = -w * natural_logarithm(r > kSmallestShare ? r : kSmallestShare);
  add_terms(sums, w, v, u);
  return w;
}

/// Returns r^5.
inline __attribute__((always_inline)) float add_sample(FitSums& sums, float r, float u) {
  const float r2 = r * r;
  const float w = r2 * r2;
  const float v = r2 * r * std::sqrt(r);  // w r^-1/2 without its division
  add_terms(sums, w, v, u);
  return w * r;
}

template <bool kLogarithm>
inline __attribute__((always_inline)) float add(FitSums& sums, float r, float u) {
  return kLogarithm ? add_logarithm(sums, r, u) : add_sample(sums, r, u);
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
