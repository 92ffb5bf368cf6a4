#define FVD_KERNEL_NAME "scalar"
#define FVD_KERNEL_NAMESPACE kernels_scalar
#include "core/focus/kernels/focus_kernels-inl.hpp"
#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd {

const FocusKernels& scalar_focus_kernels() noexcept { return kernels_scalar::kKernels; }

}  // namespace fvd
