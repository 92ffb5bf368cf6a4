#pragma once

/// How long a client may take to read what it is sent at once.

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace fvd {

/// 10 s for every 256 KiB that are begun: what is sent whole is given as long as what is sent piece by piece.
[[nodiscard]] constexpr std::chrono::seconds reading_time(std::size_t bytes) noexcept {
  constexpr std::chrono::seconds kOfAPiece{10};
  constexpr std::size_t kOfBytes = std::size_t{256} << 10U;
  const std::size_t pieces = std::max<std::size_t>(1, bytes / kOfBytes + (bytes % kOfBytes == 0 ? 0 : 1));
  return kOfAPiece * static_cast<std::chrono::seconds::rep>(pieces);
}

}  // namespace fvd
