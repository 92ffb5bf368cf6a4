#include "daemon/resources/file_stream.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::uint64_t kPiece_bytes = std::uint64_t{256} << 10U;

}  // namespace

std::string FileStream::next() {
  std::string piece(static_cast<std::size_t>(std::min(left_, kPiece_bytes)), '\0');
  if (piece.empty()) return piece;
  ssize_t got = -1;
  do {
    got = ::pread(file_.get(), piece.data(), piece.size(), static_cast<off_t>(offset_));
  } while (got < 0 && errno == EINTR);
  if (got < 0) throw Error(ErrorCode::kInternal, std::string("a file cannot be read on: ") + std::strerror(errno));
  if (got == 0) throw Error(ErrorCode::kInternal, "a file became shorter while it was sent");
  piece.resize(static_cast<std::size_t>(got));
  offset_ += piece.size();
  left_ -= piece.size();
  return piece;
}

}  // namespace fvd
