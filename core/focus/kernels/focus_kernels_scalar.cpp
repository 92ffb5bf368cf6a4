#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd::kernels_scalar {

#define FVD_KERNEL_NAME "scalar"
#include "core/focus/kernels/focus_kernels-inl.hpp"

}  // namespace fvd::kernels_scalar

namespace fvd {

const FocusKernels& scalar_focus_kernels() noexcept { return kernels_scalar::kKernels; }

}  // namespace fvd
