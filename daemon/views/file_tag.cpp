#include "daemon/views/file_tag.hpp"

#include <cerrno>
#include <cstring>
#include <sstream>

#include "daemon/surface_files/file_bytes.hpp"

namespace fvd {

std::string file_tag(const struct stat& status) {
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  std::ostringstream text;
  text << std::hex << status.st_mtim.tv_sec * kNanoseconds + status.st_mtim.tv_nsec << '-' << status.st_size << '-'
       << status.st_ino;
  return text.str();
}

std::string file_tag(const std::filesystem::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) refuse(path, "file", std::strerror(errno));
  return file_tag(status);
}

}  // namespace fvd
