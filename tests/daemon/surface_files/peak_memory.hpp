#pragma once

/// How much memory of this process was in use at most since a moment.

#include <algorithm>
#include <fstream>
#include <string>

#include <malloc.h>

namespace fvd::test {

/// Whether this is a build that does not give back what is freed, so that a reader's buffers add up.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kKeepsWhatIsFreed = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kKeepsWhatIsFreed = true;
#else
inline constexpr bool kKeepsWhatIsFreed = false;
#endif
#else
inline constexpr bool kKeepsWhatIsFreed = false;
#endif

class PeakMemory {
 public:
  /// Begins anew, where the kernel lets a process do so; else the peak of the whole process counts.
  PeakMemory() {
    // What the heap keeps from earlier would hide what is taken now.
    malloc_trim(0);
    before_mib_ = status_mib("VmRSS:");
    std::ofstream("/proc/self/clear_refs") << 5;
  }

  /// Of the peak above what was in use at the beginning.
  [[nodiscard]] double risen_mib() const { return std::max(0.0, status_mib("VmHWM:") - before_mib_); }

 private:
  static double status_mib(const std::string& key) {
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word) {
      double kib = 0.0;
      if (word == key && status >> kib) return kib / 1024.0;
    }
    return 0.0;
  }

  double before_mib_ = 0.0;
};

}  // namespace fvd::test
