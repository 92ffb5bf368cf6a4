#pragma once

/// A disk on which SQLite cannot write, or not any more.

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <initializer_list>

#include <sqlite3.h>
#include <sys/types.h>
#include <unistd.h>

namespace fvd::test {

/// While it lives, SQLite's writes fail with one errno, after the first `good_writes` of them, until it is mended. One
/// at a time. context: made and destroyed while nobody uses SQLite, mend() at any time.
class BrokenDisk {
 public:
  explicit BrokenDisk(int error, int good_writes = 0) {
    error_ = error;
    good_writes_ = good_writes;
    mended_ = false;
    for (const char* call : {"pwrite", "pwrite64"}) set(call, reinterpret_cast<sqlite3_syscall_ptr>(&try_pwrite));
    set("write", reinterpret_cast<sqlite3_syscall_ptr>(&try_write));
  }
  ~BrokenDisk() {
    for (const char* call : {"pwrite", "pwrite64", "write"}) set(call, nullptr);  // nullptr: the real one again
  }
  BrokenDisk(const BrokenDisk&) = delete;
  BrokenDisk& operator=(const BrokenDisk&) = delete;

  void mend() { mended_ = true; }
  /// As a new one.
  void break_again(int error, int good_writes) {
    error_ = error;
    good_writes_ = good_writes;
    mended_ = false;
  }

  /// True once a write failed.
  [[nodiscard]] bool has_failed() const { return good_writes_ < 0; }

 private:
  static void set(const char* call, sqlite3_syscall_ptr function) {
    sqlite3_vfs* vfs = sqlite3_vfs_find(nullptr);
    vfs->xSetSystemCall(vfs, call, function);
  }
  static bool fails() {
    if (mended_) return false;
    if (good_writes_ > 0) {
      --good_writes_;
      return false;
    }
    good_writes_ = -1;
    errno = error_;
    return true;
  }
  static ssize_t try_pwrite(int file, const void* bytes, std::size_t count, off_t offset) {
    return fails() ? -1 : ::pwrite(file, bytes, count, offset);
  }
  static ssize_t try_write(int file, const void* bytes, std::size_t count) {
    return fails() ? -1 : ::write(file, bytes, count);
  }
  static inline std::atomic<int> error_ = 0;
  static inline std::atomic<int> good_writes_ = 0;
  static inline std::atomic<bool> mended_ = false;
};

}  // namespace fvd::test
