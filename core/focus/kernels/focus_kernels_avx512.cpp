#define FVD_KERNEL_NAME "avx512"
#define FVD_KERNEL_NAMESPACE kernels_avx512
#define FVD_KERNEL_AVX2
#define FVD_KERNEL_AVX512
#include "core/focus/kernels/focus_kernels_common.hpp"

// After the standard library's headers and before the kernels: see focus_kernels_common.hpp.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#include "core/focus/kernels/focus_kernels-inl.hpp"
#if defined(__clang__)
#pragma clang attribute pop
#endif

namespace fvd {

const FocusKernels& avx512_focus_kernels() noexcept { return kernels_avx512::kKernels; }

}  // namespace fvd
