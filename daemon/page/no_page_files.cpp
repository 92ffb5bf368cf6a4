/// In place of the operator page, where it was not to be built (FVD_WEB=OFF) or could not be.

#include "daemon/page/page_files.hpp"

namespace fvd {

std::span<const PageFile> page_files() noexcept { return {}; }

}  // namespace fvd
