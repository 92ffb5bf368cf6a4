#include "core/focus/kernels/focus_kernels.hpp"

#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd {

namespace {

std::vector<const FocusKernels*> runnable() {
  std::vector<const FocusKernels*> kernels{&scalar_focus_kernels(), &baseline_focus_kernels()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") != 0) kernels.push_back(&avx2_focus_kernels());
  if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
      __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0) {
    kernels.push_back(&avx512_focus_kernels());
  }
#endif
  return kernels;
}

const FocusKernels& chosen() {
  const auto all = all_focus_kernels();
  const char* forced = std::getenv("FVD_FORCE_KERNEL");
  if (forced == nullptr || *forced == '\0') return *all.back();
  std::string names;
  for (const FocusKernels* kernels : all) {
    if (kernels->name == forced) return *kernels;
    names += names.empty() ? "" : ", ";
    names += kernels->name;
  }
  throw Error(ErrorCode::kBadInput, "FVD_FORCE_KERNEL is '" + std::string(forced) + "': this processor runs " + names);
}

}  // namespace

std::span<const FocusKernels* const> all_focus_kernels() noexcept {
  static const std::vector<const FocusKernels*> kernels = runnable();
  return kernels;
}

const FocusKernels& focus_kernels() {
  static const FocusKernels& kernels = chosen();
  return kernels;
}

}  // namespace fvd
