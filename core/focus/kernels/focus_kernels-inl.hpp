// The kernels' one source. Included inside a namespace of its own by one file a target, never by anything else.
//
// Loops without branches over plain arrays: the shape g++ turns into vector code. Look at the code that runs (objdump),
// not at the source: a conditional too many, and the loop is scalar.

// The first is what the others are made of.
// clang-format off
#include "core/focus/kernels/kernel_vectors-inl.hpp"
#include "core/focus/kernels/kernel_operators-inl.hpp"
#include "core/focus/kernels/kernel_windows-inl.hpp"
#include "core/focus/kernels/kernel_update-inl.hpp"
#include "core/focus/kernels/kernel_noise-inl.hpp"
#if defined(FVD_KERNEL_AVX512)  // what makes the map gains a tenth by it; what goes over slices loses as much
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")
#endif
#include "core/focus/kernels/kernel_fit-inl.hpp"
#include "core/focus/kernels/kernel_neighbours-inl.hpp"
// clang-format on

constexpr FocusKernels kKernels{
    .name = FVD_KERNEL_NAME,
    .laplacian_u16 = laplacian_u16,
    .tenengrad_u8 = tenengrad_u8,
    .tenengrad_u16 = tenengrad_u16,
    .enter_laplacian_u8 = enter_laplacian_u8,
    .slide_u32 = slide_u32,
    .window_sums_u16 = window_sums_u16,
    .window_sums_u32 = window_sums_u32,
    .root_code = root_code,
    .maximum_u8 = maximum_u8,
    .maximum_u16 = maximum_u16,
    .add_to_bin = add_to_bin,
    .widen_u8 = widen_u8,
    .update_u8 = update_u8,
    .update_u16 = update_u16,
    .noise_u8 = noise_u8,
    .noise_u16 = noise_u16,
    .fit_five = fit_five,
    .raise_amplitudes = raise_amplitudes,
    .finish_sigma = finish_sigma,
};
