/// Datagrams to the simulated camera's control: each has its length, and who sends it, before it.

#include <memory>

#include <spdlog/spdlog.h>

#include "sim/camera/gige_control.hpp"
#include "sim/world/frame_source.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::sim {

namespace {

using test::require;

/// A small black picture.
class Black final : public FrameSource {
 public:
  [[nodiscard]] int sensor_width() const override { return 64; }
  [[nodiscard]] int sensor_height() const override { return 48; }
  void render(const ExposureRequest& /*request*/, std::span<std::byte> out) override {
    std::fill(out.begin(), out.end(), std::byte{0});
  }
};

constexpr std::uint32_t kLoopback = 0x7F000001;

/// Packets of pictures go nowhere but to loopback: a socket that is bound there reaches nothing else.
struct Camera {
  Black source;
  CameraRegisters registers{{.sensor_width = 64, .sensor_height = 48, .chunk_mode = true}};
  CameraFaultScript faults;
  Standstill mute;
  Standstill hung;
  GvspSender sender{kLoopback, 0.0, 1};
  GigeStreamer streamer{source, registers, faults, mute, hung, sender, 1, false, [](const CameraFaultStep&) {}};
  GigeControl control{registers,
                      streamer,
                      sender,
                      faults,
                      [](const CameraFaultStep&) {},
                      [](std::uint32_t address) { return address >> 24U == 127U; }};
};

void check_answer(std::span<const std::uint8_t> packet, std::span<const std::uint8_t> answer) {
  if (answer.empty()) return;
  require(packet.size() >= gvcp::kHeaderBytes && answer.size() >= gvcp::kHeaderBytes);
  require(gvcp::get16(answer, 2) == static_cast<std::uint16_t>(gvcp::get16(packet, 2) + 1));
  require(gvcp::get16(answer, 4) == answer.size() - gvcp::kHeaderBytes);
  require(gvcp::get16(answer, 6) == gvcp::get16(packet, 6));
}

}  // namespace

}  // namespace fvd::sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd::sim;
  spdlog::set_level(spdlog::level::off);
  static Camera camera;
  fvd::test::InputReader input({bytes, size});
  while (!input.empty()) {
    const std::uint8_t from = input.byte();
    const GvcpPeer peer{kLoopback, static_cast<std::uint16_t>(50000 + from % 2)};
    const std::size_t length = input.byte();
    const auto packet = input.bytes(length * 4);
    if (from >= 0xF0) {
      check_answer(packet, camera.control.answer_broadcast(peer, packet));
    } else {
      check_answer(packet, camera.control.answer(peer, packet).acknowledge);
    }
  }
  camera.control.restart();
  return 0;
}
