#include "daemon/export/replace_file.hpp"

#include <cerrno>

#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

void replace_file(const std::filesystem::path& path, std::string_view bytes) {
  (void)replace_file(path, [bytes](const ByteSink& sink) { sink(bytes); });
}

std::uint64_t replace_file(const std::filesystem::path& path, const ByteProducer& produce) {
  const std::filesystem::path temporary = path.parent_path() / ("." + path.filename().string() + ".tmp");
  remove_file(temporary);  // of a process that was killed
  UnsyncedFile file(temporary, produce);
  file.finish();
  if (file_calls().rename(temporary, path) != 0) {
    const int reason = errno;
    file_calls().unlink(temporary);
    throw storage_error(reason, "rename the finished file to", path);
  }
  sync_directory(path.parent_path());
  return file.size_bytes();
}

}  // namespace fvd
