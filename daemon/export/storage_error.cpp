#include "daemon/export/storage_error.hpp"

#include <cerrno>
#include <string>
#include <system_error>

namespace fvd {

Error storage_error(int error_number, std::string_view action, const std::filesystem::path& path) {
  const bool full = error_number == ENOSPC || error_number == EDQUOT;
  std::string message =
      "cannot " + std::string(action) + " " + path.string() + ": " + std::generic_category().message(error_number);
  if (full) message += ": free some space and repeat";
  return {full ? ErrorCode::kStorageFull : ErrorCode::kStorageWrite, message};
}

}  // namespace fvd
