/// An answer to the search for cameras.

#include "drivers/gige/camera_discovery.hpp"
#include "drivers/gige/gvcp_socket.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  const auto ack = gvcp::acknowledge_of({bytes, size});
  if (!ack) return 0;
  test::require(ack->pending() >= std::chrono::milliseconds(0));
  const auto camera = camera_of_answer(ack->payload);
  if (!camera) return 0;
  test::require(gvcp::address_of(camera->address).has_value() && camera->mac.size() == 17);
  test::require(camera->is_called(camera->address) && camera->is_called(camera->mac));
  for (const char c : camera->text()) test::require(static_cast<unsigned char>(c) >= 0x20);
  return 0;
}
