#pragma once

/// Calls that bring files to the disk, of which one fails, or all from one on.

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <mutex>

#include "daemon/export/file_calls.hpp"

namespace fvd::test {

enum class FaultLasts { kOnce, kUntilMended };

/// And none writes all at once. context: thread-safe.
class FaultyCalls final : public FileCalls {
 public:
  /// The call after `good` others fails with that errno.
  FaultyCalls(int good, int reason, FaultLasts lasts) : good_(good), reason_(reason), lasts_(lasts) {}

  /// Counts anew from here on. Calls that run go on.
  void arm(int good, int reason) {
    const std::lock_guard lock(mutex_);
    calls_ = 0;
    mended_ = false;
    good_ = good;
    reason_ = reason;
  }
  void mend() {
    const std::lock_guard lock(mutex_);
    mended_ = true;
  }
  [[nodiscard]] bool has_failed() const {
    const std::lock_guard lock(mutex_);
    return calls_ > good_;
  }

  int create(const std::filesystem::path& path, mode_t mode) override {
    return fails() ? -1 : FileCalls::create(path, mode);
  }
  ssize_t write(int fd, const void* bytes, std::size_t count) override {
    return fails() ? -1 : FileCalls::write(fd, bytes, std::max<std::size_t>(1, count / 2));
  }
  int allocate(int fd, std::int64_t bytes) override { return fails() ? -1 : FileCalls::allocate(fd, bytes); }
  int sync(int fd) override { return fails() ? -1 : FileCalls::sync(fd); }
  int close(int fd) override {
    const bool failed = fails();
    const int reason = errno;
    const int closed = FileCalls::close(fd);
    if (!failed) return closed;
    errno = reason;
    return -1;
  }
  int make_directory(const std::filesystem::path& path) override {
    return fails() ? -1 : FileCalls::make_directory(path);
  }
  int sync_directory(const std::filesystem::path& path) override {
    return fails() ? -1 : FileCalls::sync_directory(path);
  }
  int rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to) override {
    return fails() ? -1 : FileCalls::rename_to_new(from, to);
  }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    return fails() ? -1 : FileCalls::rename(from, to);
  }
  int unlink(const std::filesystem::path& path) override { return fails() ? -1 : FileCalls::unlink(path); }
  int set_mode(const std::filesystem::path& path, mode_t mode) override {
    return fails() ? -1 : FileCalls::set_mode(path, mode);
  }
  int set_owner(const std::filesystem::path& path, uid_t user, gid_t group) override {
    return fails() ? -1 : FileCalls::set_owner(path, user, group);
  }
  void remove_all(const std::filesystem::path& path) noexcept override {
    if (!fails()) FileCalls::remove_all(path);
  }

 private:
  bool fails() {
    const std::lock_guard lock(mutex_);
    if (mended_) return false;
    const int call = calls_++;
    if (call < good_ || (call > good_ && lasts_ == FaultLasts::kOnce)) return false;
    errno = reason_;
    return true;
  }

  mutable std::mutex mutex_;
  int calls_ = 0;
  bool mended_ = false;
  int good_;
  int reason_;
  const FaultLasts lasts_;
};

}  // namespace fvd::test
