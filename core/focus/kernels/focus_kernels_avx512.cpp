#include "core/focus/kernels/focus_kernels_common.hpp"

#pragma GCC target("avx2")

namespace fvd::kernels_avx512 {

#define FVD_KERNEL_NAME "avx512"
#define FVD_KERNEL_AVX2
#define FVD_KERNEL_AVX512
#include "core/focus/kernels/focus_kernels-inl.hpp"

}  // namespace fvd::kernels_avx512

namespace fvd {

const FocusKernels& avx512_focus_kernels() noexcept { return kernels_avx512::kKernels; }

}  // namespace fvd
