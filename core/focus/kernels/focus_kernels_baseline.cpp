#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd::kernels_baseline {

#define FVD_KERNEL_NAME "baseline"
#include "core/focus/kernels/focus_kernels-inl.hpp"

}  // namespace fvd::kernels_baseline

namespace fvd {

const FocusKernels& baseline_focus_kernels() noexcept { return kernels_baseline::kKernels; }

}  // namespace fvd
