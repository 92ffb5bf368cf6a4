/// main.xml alone: behind the checksums of an archive the fuzzer of whole files hardly gets to it.

#include <cstdint>
#include <cstdlib>

#include "core/base/error.hpp"
#include "daemon/surface_files/x3p_main.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    const std::string_view xml(reinterpret_cast<const char*>(bytes), size);
    if (fvd::read_x3p_main("a.x3p", xml, {}).size.points() == 0) std::abort();
  } catch (const fvd::Error& error) {
    if (error.code() != fvd::ErrorCode::kSurfaceFile) std::abort();
  }
  return 0;
}
