/// A drive's profile.

#include <cmath>

#include "core/base/error.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  try {
    const DriveProfile profile = parse_drive_profile(test::text_of({bytes, size}), "profile");
    test::require(profile.steps_per_um > 0.0 && profile.counts_per_um > 0.0 && std::abs(profile.direction) == 1);
    for (const DriveUnit& unit : {profile.speed, profile.acceleration}) {
      for (const double physical : {1e-300, 1.0, 1e300}) {
        const std::int64_t value = unit.value(physical);
        test::require(value >= unit.min && value <= unit.max);
      }
    }
    for (const int code : {-1, 0, 1, 0x30, 0xFFFF}) test::require(!alarm_text(profile, code).empty());
  } catch (const Error& error) {
    test::require(error.code() == ErrorCode::kBadConfig);
  }
  return 0;
}
