#pragma once

/// What every compilation of the kernels includes before its target is set: nothing of the standard library may be
/// compiled for a processor that the rest of the program does not need. The intrinsics carry targets of their own.

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/focus/kernels/five_sample_fit.hpp"
#include "core/focus/kernels/focus_kernels.hpp"
#include "core/surface/mask_reason.hpp"

/// Name and namespace of one compilation, defined by its file before it includes anything. A fragment that is compiled
/// alone, by a check or an editor, is the baseline's.
#ifndef FVD_KERNEL_NAMESPACE
#define FVD_KERNEL_NAME "baseline"
#define FVD_KERNEL_NAMESPACE kernels_baseline
#endif

/// Before a loop: no iteration reads what another writes. g++ 12 checks many pointers against each other otherwise, and
/// then gives the vector code up.
#if defined(__GNUC__) && !defined(__clang__)
#define FVD_NO_ALIASING _Pragma("GCC ivdep")
#else
#define FVD_NO_ALIASING
#endif

namespace fvd {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

[[nodiscard]] const FocusKernels& scalar_focus_kernels() noexcept;
[[nodiscard]] const FocusKernels& baseline_focus_kernels() noexcept;
#if defined(__x86_64__)
[[nodiscard]] const FocusKernels& avx2_focus_kernels() noexcept;
[[nodiscard]] const FocusKernels& avx512_focus_kernels() noexcept;
#endif

}  // namespace fvd
