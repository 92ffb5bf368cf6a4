#pragma once

/// Macros by which clang's -Wthread-safety checks who holds which mutex; empty for other compilers.
/// After https://clang.llvm.org/docs/ThreadSafetyAnalysis.html.

#if defined(__clang__)
#define FVD_THREAD_ANNOTATION(x) __attribute__((x))
#else
#define FVD_THREAD_ANNOTATION(x)
#endif

/// A member that may be read and written only while the mutex is held.
#define FVD_GUARDED_BY(mutex) FVD_THREAD_ANNOTATION(guarded_by(mutex))
/// A pointer whose target may be used only while the mutex is held.
#define FVD_PT_GUARDED_BY(mutex) FVD_THREAD_ANNOTATION(pt_guarded_by(mutex))
/// A function whose caller holds the mutex.
#define FVD_REQUIRES(...) FVD_THREAD_ANNOTATION(requires_capability(__VA_ARGS__))
/// A function that takes the mutex itself: its caller must not hold it.
#define FVD_EXCLUDES(...) FVD_THREAD_ANNOTATION(locks_excluded(__VA_ARGS__))

#define FVD_CAPABILITY(name) FVD_THREAD_ANNOTATION(capability(name))
#define FVD_SCOPED_CAPABILITY FVD_THREAD_ANNOTATION(scoped_lockable)
#define FVD_ACQUIRE(...) FVD_THREAD_ANNOTATION(acquire_capability(__VA_ARGS__))
#define FVD_TRY_ACQUIRE(...) FVD_THREAD_ANNOTATION(try_acquire_capability(__VA_ARGS__))
#define FVD_RELEASE(...) FVD_THREAD_ANNOTATION(release_capability(__VA_ARGS__))
#define FVD_ASSERT_CAPABILITY(x) FVD_THREAD_ANNOTATION(assert_capability(x))
#define FVD_RETURN_CAPABILITY(x) FVD_THREAD_ANNOTATION(lock_returned(x))
/// The analysis cannot follow the function; a comment says why it is right all the same.
#define FVD_NO_THREAD_SAFETY_ANALYSIS FVD_THREAD_ANNOTATION(no_thread_safety_analysis)
