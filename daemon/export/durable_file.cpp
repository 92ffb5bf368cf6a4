#include "daemon/export/durable_file.hpp"

#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include "daemon/export/storage_error.hpp"
#include "daemon/unique_fd.hpp"

namespace fvd {

void write_all(int fd, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      throw storage_error(errno, "write", path);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void write_new_file(const std::filesystem::path& path, std::string_view bytes) {
  UniqueFd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!file.valid()) throw storage_error(errno, "create", path);
  try {
    write_all(file.get(), bytes, path);
    // After a failed fsync the state of the cached pages is unknown: report, never retry.
    if (::fsync(file.get()) != 0) throw storage_error(errno, "bring to disk", path);
    if (::close(file.release()) != 0) throw storage_error(errno, "close", path);
  } catch (...) {
    ::unlink(path.c_str());
    throw;
  }
}

void sync_directory(const std::filesystem::path& directory) {
  const UniqueFd fd(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!fd.valid()) throw storage_error(errno, "open directory", directory);
  if (::fsync(fd.get()) != 0) throw storage_error(errno, "bring to disk directory", directory);
}

}  // namespace fvd
