#pragma once

/// What the fuzzers of readers of surface files do: bytes in, a surface or Error kSurfaceFile out, nothing else.

#include "core/base/error.hpp"
#include "daemon/surface_files/surface_readers.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

inline int fuzz_reader(Surface (*read)(const std::filesystem::path&, const SurfaceReadOptions&),
                       const SurfaceReadOptions& options, const std::uint8_t* bytes, std::size_t size) {
  const InputFile file({bytes, size});
  try {
    const Surface surface = read(file.path(), options);
    require(!surface.height_m.empty() && surface.pitch_x_um > 0.0 && surface.pitch_y_um > 0.0);
  } catch (const Error& error) {
    require(error.code() == ErrorCode::kSurfaceFile);
  }
  return 0;
}

}  // namespace fvd::test
