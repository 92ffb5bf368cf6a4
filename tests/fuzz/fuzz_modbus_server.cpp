/// Requests to the simulated drives. The first byte of the input chooses the drive; each request has its length before
/// it.

#include "sim/axis/axis_model.hpp"
#include "sim/drives/drive_kinds.hpp"
#include "sim/modbus/modbus_responder.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::sim {

namespace {

using test::require;

constexpr std::size_t kLongestPdu = 253;

void check_answer(std::span<const std::uint8_t> request, const ModbusBytes& answer) {
  if (request.empty()) return require(answer.empty());
  require(!answer.empty() && answer.size() <= kLongestPdu);
  require(answer[0] == request[0] || (answer[0] == (request[0] | 0x80U) && answer.size() == 2));
}

}  // namespace

}  // namespace fvd::sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  using namespace fvd::sim;
  test::InputReader input({bytes, size});
  HostTime now{std::chrono::hours(1)};
  AxisModel axis{AxisParameters{}};
  const auto kind = static_cast<DriveKind>(input.byte() % drive_names().size());
  const auto drive = make_drive(kind, axis, [&now] { return now; });
  while (!input.empty()) {
    const auto request = input.bytes(input.byte());
    (void)summary_of(request);
    (void)rtu_frame_length(request);
    check_answer(request, respond(*drive, request));
    drive->idle();
    now += std::chrono::milliseconds(7);
  }
  return 0;
}
