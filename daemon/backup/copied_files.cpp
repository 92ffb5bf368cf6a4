#include "daemon/backup/copied_files.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece_bytes = std::size_t{1} << 20U;

void copy_bytes(const fs::path& from, const fs::path& to) {
  std::ifstream source(from, std::ios::binary);
  if (!source) throw Error(ErrorCode::kBadInput, "cannot read " + from.string());
  const auto mode = static_cast<mode_t>(fs::status(from).permissions());
  // From the beginning: a file of tokens is at no time more readable than it was, and whoever opens it reads on.
  const auto copy = [&](const ByteSink& sink) {
    // And what the process' mask took away.
    if (file_calls().set_mode(to, mode) != 0) throw storage_error(errno, "set the permissions of", to);
    give_to_owner_of(from, to);
    std::vector<char> piece(kPiece_bytes);
    while (source) {
      source.read(piece.data(), static_cast<std::streamsize>(piece.size()));
      sink({piece.data(), static_cast<std::size_t>(source.gcount())});
    }
    if (!source.eof()) throw Error(ErrorCode::kBadInput, "cannot read all of " + from.string());
  };
  write_new_file(to, copy, mode);
}

void copy_below(const fs::path& from, const fs::path& to) {
  if (!fs::is_directory(from)) return copy_bytes(from, to);
  (void)make_directories(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    if (entry.path().filename().string().starts_with('.')) continue;
    copy_below(entry.path(), to / entry.path().filename());
  }
  sync_directory(to);
}

}  // namespace

void copy_durably(const fs::path& from, const fs::path& to) {
  try {
    if (from.empty() || !fs::exists(from)) return;
    (void)make_directories(fs::absolute(to).parent_path());
    copy_below(from, to);
    sync_directory(fs::absolute(to).parent_path());
  } catch (const fs::filesystem_error& failure) {
    throw Error(ErrorCode::kBadInput, failure.what());
  }
}

void give_to_owner_of(const fs::path& like, const fs::path& path) {
  struct stat owner {};
  if (::geteuid() != 0 || ::stat(like.c_str(), &owner) != 0) return;
  const auto give = [&owner](const fs::path& one) {
    if (file_calls().set_owner(one, owner.st_uid, owner.st_gid) != 0) throw storage_error(errno, "give away", one);
  };
  std::error_code error;
  if (!fs::exists(path, error)) return;
  give(path);
  if (!fs::is_directory(path, error)) return;
  for (const auto& entry : fs::recursive_directory_iterator(path)) give(entry.path());
}

}  // namespace fvd
