/// What the description of a TIFF says of its pages.

#include <algorithm>
#include <cmath>

#include "drivers/replay/page_description.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

namespace {

void check(const PageDescription& told) {
  if (!told.problem.empty()) return;
  require(told.slices >= 1 && told.channels >= 1 && told.times >= 1 && !told.pages.empty());
  const auto within = [](int value, int count) { return value >= 0 && value < count; };
  for (const PagePlace& place : told.pages) {
    require(place.page >= 0 && within(place.z, told.slices) && within(place.channel, told.channels) &&
            within(place.time, told.times));
    require(!place.z_um || std::isfinite(*place.z_um));
  }
  require(!told.spacing_um || (std::isfinite(*told.spacing_um) && *told.spacing_um != 0.0));
  for (const auto& pitch : {told.pixel_pitch_x_um, told.pixel_pitch_y_um}) {
    require(!pitch || (std::isfinite(*pitch) && *pitch > 0.0));
  }
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  const std::string_view text = test::text_of({bytes, size});
  if (const auto told = read_imagej_description(text)) test::check(*told);
  for (const int samples : {1, 3}) {
    if (const auto told = read_ome_description(text, "a.ome.tif", samples)) test::check(*told);
  }
  return 0;
}
