#pragma once

/// What all fuzzers of readers do: bytes in, a surface or Error kSurfaceFile out, nothing else.

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/surface_files/surface_readers.hpp"

namespace fvd::test {

/// The readers take files: one in memory, made anew for every input.
inline int fuzz_reader(Surface (*read)(const std::filesystem::path&, const SurfaceReadOptions&),
                       const SurfaceReadOptions& options, const std::uint8_t* bytes, std::size_t size) {
  const int file = ::memfd_create("surface", MFD_CLOEXEC);
  if (file < 0 || ::write(file, bytes, size) != static_cast<ssize_t>(size)) std::abort();
  try {
    const Surface surface = read("/proc/self/fd/" + std::to_string(file), options);
    if (surface.height_m.empty() || !(surface.pitch_x_um > 0.0) || !(surface.pitch_y_um > 0.0)) std::abort();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kSurfaceFile) std::abort();
  }
  ::close(file);
  return 0;
}

}  // namespace fvd::test
