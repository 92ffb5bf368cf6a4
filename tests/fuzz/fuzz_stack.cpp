/// A TIFF of several pages as a recorded stack: which pages are slices, by what its description says, and their pixels.

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "drivers/replay/recorded_stack.hpp"
#include "drivers/replay/slice_heights.hpp"
#include "drivers/replay/tiff_pages.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  spdlog::set_level(spdlog::level::off);
  const test::InputFile file({bytes, size});
  try {
    const SliceList list = tiff_slices(file.path(), {});
    test::require(list.slices.size() >= 2 && (list.z_um.empty() || list.z_um.size() == list.slices.size()));
    const RecordedStack stack(list);
    constexpr int kMostSlices = 8;
    for (int i = 0; i < std::min(stack.slices(), kMostSlices); ++i) (void)stack.read(i);
  } catch (const Error& error) {
    test::require(error.code() == ErrorCode::kBadInput);
  }
  return 0;
}
