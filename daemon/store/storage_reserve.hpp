#pragma once

/// Room on the disk that is held for the end of the job that was accepted.

#include <cstdint>
#include <filesystem>
#include <utility>

namespace fvd {

/// A file of zeros beside the database. Given back, its room takes the row that ends a job where the disk has filled up
/// meanwhile.
/// context: one thread at a time.
class StorageReserve {
 public:
  /// Of a row with a large result.json, twice: once in the write-ahead log, once in the database.
  static constexpr std::int64_t kBytes = std::int64_t{8} << 20U;

  explicit StorageReserve(std::filesystem::path file) : file_(std::move(file)) {}

  /// Makes the file if it is not there in its full size. Throws Error kStorageFull, kStorageWrite.
  void take();
  /// Removes it.
  void give_back() noexcept;

 private:
  std::filesystem::path file_;
  bool taken_ = false;
};

}  // namespace fvd
