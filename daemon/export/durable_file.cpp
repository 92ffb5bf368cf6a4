#include "daemon/export/durable_file.hpp"

#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

void write_all(int fd, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = file_calls().write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      throw storage_error(errno, "write", path);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

UnsyncedFile::UnsyncedFile(const std::filesystem::path& path, std::string_view bytes)
    : UnsyncedFile(path, [bytes](const ByteSink& sink) { sink(bytes); }) {}

UnsyncedFile::UnsyncedFile(const std::filesystem::path& path, const ByteProducer& produce, mode_t mode)
    : path_(path), file_(file_calls().create(path, mode)) {
  if (!file_.valid()) throw storage_error(errno, "create", path_);
  try {
    produce([this](std::string_view bytes) {
      write_all(file_.get(), bytes, path_);
      size_bytes_ += bytes.size();
    });
  } catch (...) {
    file_calls().unlink(path_);
    throw;
  }
  // Only a head start: finish() sees every error, and a file system without it loses nothing but time.
  ::sync_file_range(file_.get(), 0, 0, SYNC_FILE_RANGE_WRITE);
}

void UnsyncedFile::finish() {
  try {
    // After a failed fsync the state of the cached pages is unknown: report, never retry.
    if (file_calls().sync(file_.get()) != 0) throw storage_error(errno, "bring to disk", path_);
    if (file_calls().close(file_.release()) != 0) throw storage_error(errno, "close", path_);
  } catch (...) {
    file_calls().unlink(path_);
    throw;
  }
}

void write_new_file(const std::filesystem::path& path, std::string_view bytes) { UnsyncedFile(path, bytes).finish(); }

void write_new_file(const std::filesystem::path& path, const ByteProducer& produce, mode_t mode) {
  UnsyncedFile(path, produce, mode).finish();
}

void write_new_file_at_will(const std::filesystem::path& path, const std::function<void(int fd)>& write) {
  UniqueFd file(file_calls().create(path, kReadableFile));
  if (!file.valid()) throw storage_error(errno, "create", path);
  try {
    write(file.get());
    if (file_calls().sync(file.get()) != 0) throw storage_error(errno, "bring to disk", path);
    if (file_calls().close(file.release()) != 0) throw storage_error(errno, "close", path);
  } catch (...) {
    file_calls().unlink(path);
    throw;
  }
}

void sync_directory(const std::filesystem::path& directory) {
  if (file_calls().sync_directory(directory) != 0) throw storage_error(errno, "bring to disk directory", directory);
}

}  // namespace fvd
