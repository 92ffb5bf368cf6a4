#include "daemon/store/storage_reserve.hpp"

#include <cerrno>

#include "daemon/base/unique_fd.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

void StorageReserve::take() {
  if (taken_) return;
  remove_file(file_);  // of the process before
  const UniqueFd file(file_calls().create(file_, kReadableFile));
  if (!file.valid()) throw storage_error(errno, "create", file_);
  if (file_calls().allocate(file.get(), kBytes) != 0) {
    const int reason = errno;
    file_calls().unlink(file_);
    throw storage_error(reason, "hold room for the end of a job in", file_);
  }
  taken_ = true;
}

void StorageReserve::give_back() noexcept {
  file_calls().unlink(file_);
  taken_ = false;
}

}  // namespace fvd
