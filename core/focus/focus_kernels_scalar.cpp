#include "core/focus/focus_kernels_common.hpp"

namespace fvd::kernels_scalar {

#define FVD_KERNEL_NAME "scalar"
#include "core/focus/focus_kernels.inc"

}  // namespace fvd::kernels_scalar

namespace fvd {

const FocusKernels& scalar_focus_kernels() noexcept { return kernels_scalar::kKernels; }

}  // namespace fvd
