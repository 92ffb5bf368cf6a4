#define FVD_KERNEL_NAME "baseline"
#define FVD_KERNEL_NAMESPACE kernels_baseline
#include "core/focus/kernels/focus_kernels-inl.hpp"
#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd {

const FocusKernels& baseline_focus_kernels() noexcept { return kernels_baseline::kKernels; }

}  // namespace fvd
