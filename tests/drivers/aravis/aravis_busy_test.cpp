/// A camera that is busy or silent for a while is not gone.

#include <array>
#include <atomic>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/runtime/guarded_thread.hpp"
#include "drivers/aravis/busy_commands.hpp"
#include "drivers/aravis/gvcp_probe.hpp"
#include "tests/drivers/aravis/aravis_camera_fixture.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using sim::CameraEvent;
using sim::CameraFault;
using std::chrono::milliseconds;
using test::AnAravisCamera;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST_F(AnAravisCamera, RepeatsCommandsThatAreRefusedAsBusy) {
  serve();
  const auto camera = open();
  const std::uint64_t before = busy_answers();
  for (int i = 0; i < 20; ++i) fault({.fault = CameraFault::kBusy, .after = i % 4});
  camera->configure(settings());
  for (std::uint64_t i = 1; i <= 5; ++i) {
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
    EXPECT_TRUE(shows(*frame, i)) << "a refused trigger exposes nothing";
  }
  EXPECT_EQ(server_->faults().unconsumed(), 0U);
  EXPECT_EQ(busy_answers() - before, 20U);
}

TEST_F(AnAravisCamera, OpensACameraThatIsBusyNowAndThen) {
  serve();
  for (int i = 0; i < 6; ++i) fault({.fault = CameraFault::kBusy, .after = 3});
  const auto camera = open();
  camera->configure(settings());
  EXPECT_TRUE(shoot(*camera).has_value());
}

TEST_F(AnAravisCamera, SaysThatACameraStaysBusy) {
  serve();
  const auto camera = open();
  fault({.fault = CameraFault::kBusy, .count = 1000});
  FVD_EXPECT_ERROR_SAYING(kCameraSettings, camera->configure(settings()), HasSubstr("busy"));
}

TEST_F(AnAravisCamera, WaitsForAsLongAsAPendingAcknowledgeSays) {
  serve();
  CameraConfig impatient = config();
  impatient.silence_ms = 200;
  const auto camera = open_aravis_camera(impatient);
  fault({.fault = CameraFault::kPendingAck, .after = 2, .delay = milliseconds(1500), .value = 3000});
  camera->configure(settings());
  fault({.fault = CameraFault::kPendingAck, .delay = milliseconds(700), .value = 1400});
  camera->trigger();
  int good = 0;
  for (int i = 0; i < 4 && good == 0; ++i) {
    const auto frame = shoot(*camera);
    if (frame && frame->status == FrameStatus::kOk) ++good;
  }
  EXPECT_EQ(good, 1);
  EXPECT_TRUE(camera->connected());
  EXPECT_EQ(server_->faults().unconsumed(), 0U);
}

TEST_F(AnAravisCamera, SurvivesSilenceThatIsShorterThanConfigured) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  fault({.fault = CameraFault::kMute, .after = 1, .delay = milliseconds(600)});
  fault({.fault = CameraFault::kMute, .on = CameraEvent::kCommand, .after = 1, .delay = milliseconds(600)});
  int good = 0;
  for (int i = 0; i < 12; ++i) {
    const auto frame = shoot(*camera);
    good += frame && frame->status == FrameStatus::kOk ? 1 : 0;
  }
  EXPECT_GE(good, 4);
  EXPECT_EQ(server_->faults().unconsumed(), 0U);
}

TEST_F(AnAravisCamera, NoticesLossAfterTheConfiguredSilence) {
  serve();
  CameraConfig impatient = config();
  impatient.silence_ms = 100;
  const auto camera = open_aravis_camera(impatient);
  camera->configure(settings());
  fault({.fault = CameraFault::kMute, .delay = milliseconds(60'000)});
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, for (int i = 0; i < 8; ++i)(void) shoot(*camera),
                          HasSubstr("answers nothing"));
}

TEST_F(AnAravisCamera, NoticesLossWhileNothingIsAskedOfIt) {
  serve();
  const auto camera = open();
  camera->look_after();
  EXPECT_TRUE(camera->connected());
  server_.reset();
  const HostTime deadline = HostClock::now() + std::chrono::seconds(20);
  while (camera->connected() && HostClock::now() < deadline) camera->look_after();
  EXPECT_FALSE(camera->connected());
}

TEST_F(AnAravisCamera, IsInterruptedWhileItIsSetUp) {
  serve();
  const auto camera = open();
  fault({.fault = CameraFault::kPendingAck, .after = 2, .delay = milliseconds(3000), .value = 6000});
  const auto interrupter = start_thread("interrupt", [&](const std::stop_token& stop) {
    while (!stop.stop_requested() && server_->faults().unconsumed() > 0) std::this_thread::yield();
    camera->interrupt();
  });
  FVD_EXPECT_ERROR(kAborted, camera->configure(settings()));
  camera->look_after();  // beside what still runs
  EXPECT_NO_THROW(camera->configure(settings())) << "after what still ran";
  EXPECT_TRUE(shoot(*camera).has_value());
}

/// Answers everything with eight bytes. With ACCESS_DENIED: nobody controls it, and it tells so to nobody; what counts
/// is that it refuses control.
class ASecretiveDevice {
 public:
  explicit ASecretiveDevice(const std::string& address, std::uint16_t status = 0x8006)
      : status_(status), socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_port = htons(3956);
    ::inet_pton(AF_INET, address.c_str(), &own.sin_addr);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own), 0);
    thread_ = start_thread("secretive", [this](const std::stop_token& stop) { serve(stop); });
  }
  ~ASecretiveDevice() {
    thread_.request_stop();
    thread_.join();
    ::close(socket_);
  }
  ASecretiveDevice(const ASecretiveDevice&) = delete;
  ASecretiveDevice& operator=(const ASecretiveDevice&) = delete;

 private:
  void serve(const std::stop_token& stop) const {
    while (!stop.stop_requested()) {
      pollfd waiting{socket_, POLLIN, 0};
      if (::poll(&waiting, 1, 10) <= 0) continue;
      std::array<std::uint8_t, 600> in{};
      sockaddr_in from{};
      socklen_t length = sizeof from;
      const auto size = ::recvfrom(socket_, in.data(), in.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
      if (size < 8 || in[0] != 0x42) continue;
      const std::array<std::uint8_t, 8> out{static_cast<std::uint8_t>(status_ >> 8U),
                                            static_cast<std::uint8_t>(status_ & 0xFFU),
                                            in[2],
                                            static_cast<std::uint8_t>(in[3] + 1),
                                            0,
                                            0,
                                            in[6],
                                            in[7]};
      ::sendto(socket_, out.data(), out.size(), 0, reinterpret_cast<const sockaddr*>(&from), length);
    }
  }

  const std::uint16_t status_;
  int socket_;
  std::jthread thread_;
};

TEST_F(AnAravisCamera, TakesARegisterWithoutAValueForNoAnswer) {
  const ASecretiveDevice device(address_, 0);
  GvcpProbe probe(address_);
  EXPECT_EQ(probe.ask(milliseconds(150)), GvcpProbe::Answer::kNone);
}

TEST_F(AnAravisCamera, BlamesNoOtherProgramWhenItsRegistersAreRefused) {
  const ASecretiveDevice device(address_);
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)open(),
                          AllOf(HasSubstr(address_), Not(HasSubstr("another program"))));
}

TEST_F(AnAravisCamera, TellsItsFormerConnectionFromAnotherProgram) {
  serve();
  const auto first = open();
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)open(),
                          AllOf(HasSubstr("given up"), Not(HasSubstr("another program"))));
}

TEST_F(AnAravisCamera, TellsAConnectionThatIsBeingClosedFromAnotherProgram) {
  serve();
  auto first = open();
  first->configure(settings());
  fault({.fault = CameraFault::kDropAck, .count = 2});
  std::atomic<bool> closed{false};
  const auto closing = start_thread("closing", [&](const std::stop_token&) {
    first.reset();
    closed = true;
  });
  int refused = 0;
  while (!closed) {
    const auto error = test::error_of([this] { (void)open(); });
    if (!error) break;
    ++refused;
    EXPECT_THAT(error->what(), Not(HasSubstr("another program")));
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace fvd
