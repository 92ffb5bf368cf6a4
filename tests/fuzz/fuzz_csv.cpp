#include "tests/fuzz/surface_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return fvd::test::fuzz_reader(fvd::read_surface_csv, {}, bytes, size);
}
