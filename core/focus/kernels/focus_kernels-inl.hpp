#pragma once

// The kernels' one source: all fragments and the table of their functions. One file per target includes it, once, after
// it has defined
//   FVD_KERNEL_NAME       what FVD_FORCE_KERNEL calls it
//   FVD_KERNEL_NAMESPACE  where its functions live, so that the four compilations do not meet in the linker
//   FVD_KERNEL_AVX2       if AVX2 may be used; the file has set it as its target
//   FVD_KERNEL_AVX512     if AVX-512 may be used as well, where it pays; the target is set here
//
// A fragment includes what it needs and opens the namespace itself. Its functions are loops without branches over plain
// arrays: the shape g++ turns into vector code, which a conditional too many undoes. The test kernels_are_vector_code
// checks the instructions.

// The order decides the target: loops over slices are compiled for AVX2 even here, because AVX-512 slows them down on
// processors that halve 512-bit instructions; the loops that make the map are a tenth faster with it.
// clang-format off
#include "core/focus/kernels/focus_kernels_common.hpp"
#include "core/focus/kernels/kernel_operators-inl.hpp"
#include "core/focus/kernels/kernel_windows-inl.hpp"
#include "core/focus/kernels/kernel_update-inl.hpp"
#include "core/focus/kernels/kernel_noise-inl.hpp"
#if defined(FVD_KERNEL_AVX512) && defined(__clang__)
#pragma clang attribute pop
#pragma clang attribute push(__attribute__((target("avx2,avx512f,avx512bw,avx512dq,avx512vl"))), apply_to = function)
#elif defined(FVD_KERNEL_AVX512)
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")
#endif
#include "core/focus/kernels/kernel_fit-inl.hpp"
#include "core/focus/kernels/kernel_neighbours-inl.hpp"
// clang-format on

namespace fvd::FVD_KERNEL_NAMESPACE {

constexpr FocusKernels kKernels{
    .name = FVD_KERNEL_NAME,
    .laplacian_u16 = laplacian_u16,
    .diagonal_u8 = diagonal_u8,
    .diagonal_u16 = diagonal_u16,
    .tenengrad_u8 = tenengrad_u8,
    .tenengrad_u16 = tenengrad_u16,
    .enter_laplacian_u8 = enter_laplacian_u8,
    .enter_diagonal_u8 = enter_diagonal_u8,
    .slide_u16 = slide_u16,
    .slide_u32 = slide_u32,
    .window_sums_u16 = window_sums_u16,
    .window_sums_u32 = window_sums_u32,
    .scale_u16 = scale_u16,
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
    .any_apart = any_apart,
    .finish_sigma = finish_sigma,
};

}  // namespace fvd::FVD_KERNEL_NAMESPACE
