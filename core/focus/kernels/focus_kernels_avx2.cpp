#include "core/focus/kernels/focus_kernels_common.hpp"

#pragma GCC target("avx2")

namespace fvd::kernels_avx2 {

#define FVD_KERNEL_NAME "avx2"
#define FVD_KERNEL_AVX2
#include "core/focus/kernels/focus_kernels-inl.hpp"

}  // namespace fvd::kernels_avx2

namespace fvd {

const FocusKernels& avx2_focus_kernels() noexcept { return kernels_avx2::kKernels; }

}  // namespace fvd
