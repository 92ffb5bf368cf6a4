#pragma once

/// Marks a kernel to be compiled for AVX2 as well and chosen when the program starts. Not under the thread sanitizer:
/// with g++ 12 the chooser runs before the sanitizer is ready and crashes. Not with other compilers.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define FVD_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define FVD_VECTOR_CLONES
#endif

/// Before a loop: no iteration reads what another writes. g++ 12 forgets `restrict` when it inlines, and then checks so
/// many pointers against each other that it gives the vector code up.
#if defined(__GNUC__) && !defined(__clang__)
#define FVD_NO_ALIASING _Pragma("GCC ivdep")
#else
#define FVD_NO_ALIASING
#endif
