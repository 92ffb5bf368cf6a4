#include "daemon/store/storage_reserve.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "daemon/base/unique_fd.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

void StorageReserve::take() {
  if (taken_) return;
  const UniqueFd file(::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0640));
  if (!file.valid()) throw storage_error(errno, "create", file_);
  if (const int reason = ::posix_fallocate(file.get(), 0, kBytes); reason != 0) {
    ::unlink(file_.c_str());
    throw storage_error(reason, "hold room for the end of a job in", file_);
  }
  taken_ = true;
}

void StorageReserve::give_back() noexcept {
  ::unlink(file_.c_str());
  taken_ = false;
}

}  // namespace fvd
