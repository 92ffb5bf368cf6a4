#pragma once

/// A disk that takes its time.

#include <condition_variable>
#include <cstddef>
#include <mutex>

#include <sqlite3.h>
#include <sys/types.h>
#include <unistd.h>

namespace fvd::test {

/// While it lives, SQLite's writes wait until they are let go. One at a time. context: made and destroyed while nobody
/// uses SQLite, the rest at any time.
class HeldDisk {
 public:
  HeldDisk() {
    held_ = true;
    waiting_ = false;
    for (const char* call : {"pwrite", "pwrite64"}) set(call, reinterpret_cast<sqlite3_syscall_ptr>(&pwrite_later));
  }
  ~HeldDisk() {
    let_go();
    for (const char* call : {"pwrite", "pwrite64"}) set(call, nullptr);  // nullptr: the real one again
  }
  HeldDisk(const HeldDisk&) = delete;
  HeldDisk& operator=(const HeldDisk&) = delete;

  /// Until a write waits.
  void await_a_write() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [] { return waiting_; });
  }
  void let_go() {
    const std::lock_guard lock(mutex_);
    held_ = false;
    changed_.notify_all();
  }

 private:
  static void set(const char* call, sqlite3_syscall_ptr function) {
    sqlite3_vfs* vfs = sqlite3_vfs_find(nullptr);
    vfs->xSetSystemCall(vfs, call, function);
  }
  static ssize_t pwrite_later(int file, const void* bytes, std::size_t count, off_t offset) {
    {
      std::unique_lock lock(mutex_);
      waiting_ = true;
      changed_.notify_all();
      changed_.wait(lock, [] { return !held_; });
    }
    return ::pwrite(file, bytes, count, offset);
  }
  static inline std::mutex mutex_;
  static inline std::condition_variable changed_;
  static inline bool held_ = false;
  static inline bool waiting_ = false;
};

}  // namespace fvd::test
