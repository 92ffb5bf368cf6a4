/// The stream of the simulated camera as packets, and its scripted faults.

#include <chrono>
#include <thread>

#include "core/base/clock.hpp"
#include "sim/faults/fault_config.hpp"
#include "tests/sim/camera/camera_client.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd::sim {
namespace {

using std::chrono::milliseconds;
using test::Bytes;
using test::GvcpClient;
using test::words;

constexpr std::uint16_t kWrite = 0x0082;
constexpr std::uint16_t kResend = 0x0040;
constexpr std::uint32_t kImageBytes = 64 * 48;

class ACameraStream : public test::CameraTest {};

TEST_F(ACameraStream, SendsItsTestPacketOnceAndForgetsThatItWasAsked) {
  open_stream();
  EXPECT_EQ(client_.write(gvcp::reg::kStreamPacketSize, gvcp::kFireTestPacket | 1000U), 0);
  const auto packet = stream_.receive(5000);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->size(), 1000U - 28U);
  EXPECT_EQ(client_.read(gvcp::reg::kStreamPacketSize), 1000U);
}

TEST_F(ACameraStream, RunsFreelyAtItsRateFromTheFirstFrameOn) {
  open_stream();
  start(false);  // 25 Hz
  std::vector<std::uint64_t> times;
  for (int i = 0; i < 3; ++i) times.push_back(time_of(receive_frame().at(0)));
  // Timestamps are those of exposures, which wait for their time; a busy machine makes them later, never earlier.
  EXPECT_GT(times[1] - times[0], 35'000'000U);
}

TEST_F(ACameraStream, EndsASingleFrameAcquisitionByItself) {
  open_stream();
  EXPECT_EQ(client_.write(feature::kAcquisitionMode, 1), 0);
  for (int i = 0; i < 2; ++i) {
    start(false);
    EXPECT_EQ(gvcp::get16(receive_frame().at(0), 2), 1) << "the first frame of its acquisition";
    EXPECT_FALSE(stream_.receive(100)) << "and the last, although a period has passed";
  }
  EXPECT_EQ(client_.write(feature::kAcquisitionMode, 2), 0x8002);
}

TEST_F(ACameraStream, TellsOfPacketsThatItHasNoMore) {
  open_stream();
  start(true);
  EXPECT_EQ(trigger_frame().size(), 5U);
  client_.send(GvcpClient::command(kResend, words({1, 1, 1}), 0x5000));
  const auto repeated = stream_.receive(5000);
  ASSERT_TRUE(repeated);
  EXPECT_EQ(gvcp::get16(*repeated, 0), 0);
  EXPECT_EQ(gvcp::get32(*repeated, 4), 0x03000001U);
  for (int i = 0; i < 4; ++i) (void)trigger_frame();
  client_.send(GvcpClient::command(kResend, words({1, 1, 2}), 0x5001));
  for (const std::uint32_t packet : {1U, 2U}) {
    const auto unavailable = stream_.receive(5000);
    ASSERT_TRUE(unavailable);
    EXPECT_EQ(unavailable->size(), 8U);
    EXPECT_EQ(gvcp::get16(*unavailable, 0), 0x800C);
    EXPECT_EQ(gvcp::get16(*unavailable, 2), 1) << "the block's number";
    EXPECT_EQ(gvcp::get32(*unavailable, 4), 0x03000000U | packet);
  }
  client_.send(GvcpClient::command(kResend, words({0x7777, 0, 0xFFFFFF}), 0x5002));
  int told = 0;
  while (stream_.receive(told < 256 ? 5000 : 50)) ++told;
  EXPECT_EQ(told, 256) << "as many packets as a request may cost";
}

TEST_F(ACameraStream, AnnouncesASlowAcknowledge) {
  open_stream();
  server_.faults().add({.fault = CameraFault::kPendingAck, .delay = milliseconds(120), .value = 700});
  const auto begin = HostClock::now();
  const Bytes command = GvcpClient::command(kWrite, words({gvcp::reg::kHeartbeatTimeout, 4000}), 0x4000);
  client_.send(command);
  const auto pending = client_.receive(5000);
  ASSERT_TRUE(pending);
  EXPECT_EQ(*pending, (Bytes{0, 0, 0, 0x89, 0, 4, 0x40, 0, 0, 0, 700 >> 8, 700 & 0xFF}));
  GvcpClient other(server_.address());
  EXPECT_EQ(other.read(gvcp::reg::kControlPrivilege), 2U) << "others are answered meanwhile";
  const auto acknowledge = client_.receive(5000);
  ASSERT_TRUE(acknowledge);
  EXPECT_EQ(gvcp::get16(*acknowledge, 2), kWrite + 1);
  EXPECT_GE(HostClock::now() - begin, milliseconds(120));
  EXPECT_EQ(client_.read(gvcp::reg::kHeartbeatTimeout), 4000U) << "executed";
}

TEST_F(ACameraStream, RefusesACommandAsBusy) {
  open_stream();
  server_.faults().add({.fault = CameraFault::kBusy});
  EXPECT_EQ(client_.write(gvcp::reg::kHeartbeatTimeout, 4000), 0x8007);
  EXPECT_EQ(client_.read(gvcp::reg::kHeartbeatTimeout), 3000U) << "not executed";
}

TEST_F(ACameraStream, MayDateOneFrameWrongly) {
  open_stream();
  start(true);
  server_.faults().add({.fault = CameraFault::kOddTime, .after = 1, .step = std::chrono::hours(1)});
  const std::uint64_t first = time_of(trigger_frame().at(0));
  const std::uint64_t second = time_of(trigger_frame().at(0));
  const std::uint64_t third = time_of(trigger_frame().at(0));
  EXPECT_GT(second - first, 3'600'000'000'000U);
  EXPECT_LT(third, second);
  EXPECT_GT(third, first);
}

TEST_F(ACameraStream, MayHaveItsClockStepped) {
  open_stream();
  start(true);
  server_.faults().add({.fault = CameraFault::kClockStep, .after = 1, .step = -std::chrono::hours(1)});
  const std::uint64_t first = time_of(trigger_frame().at(0));
  const std::uint64_t second = time_of(trigger_frame().at(0));
  EXPECT_LT(second, first - 3'000'000'000'000U);
  EXPECT_EQ(client_.write(gvcp::reg::kTimestampControl, gvcp::kLatchTimestamp), 0);
  const auto latched =
      (std::uint64_t{client_.read(gvcp::reg::kTimestampHigh)} << 32U) | client_.read(gvcp::reg::kTimestampLow);
  EXPECT_GT(latched, second);
  EXPECT_LT(latched, first);
}

TEST_F(ACameraStream, SendsChunksBehindTheImage) {
  open_stream();
  EXPECT_EQ(client_.read(feature::kPayloadSize), kImageBytes);
  EXPECT_EQ(client_.write(feature::kChunkModeActive, 1), 0);
  const std::uint32_t payload = client_.read(feature::kPayloadSize);
  EXPECT_EQ(payload, kImageBytes + 8 + 3 * 16);
  start(true);
  const auto packets = trigger_frame();
  ASSERT_EQ(packets.size(), 5U);
  EXPECT_EQ(gvcp::get32(packets[0], 8), 0x4001U);
  EXPECT_EQ(gvcp::get32(packets[0], 24), 64U) << "the width";
  Bytes image;
  for (std::size_t i = 1; i < 4; ++i) image.insert(image.end(), packets[i].begin() + 8, packets[i].end());
  ASSERT_EQ(image.size(), payload);
  // Chunks are found from the end: each ends with its id and its length.
  std::size_t end = image.size();
  for (const std::uint32_t id : {4U, 3U, 2U, 1U}) {
    EXPECT_EQ(gvcp::get32(image, end - 8), id);
    end -= 8 + gvcp::get32(image, end - 4);
  }
  EXPECT_EQ(end, 0U);
  EXPECT_EQ(gvcp::get32(image, kImageBytes + 8 + 4), 1U) << "the number of the frame";
  EXPECT_EQ(gvcp::get32(packets[4], 8), 0x4001U);
  EXPECT_EQ(gvcp::get32(packets[4], 16), payload);
  EXPECT_EQ(client_.write(feature::kChunkModeActive, 2), 0x8002);
}

TEST_F(ACameraStream, MayBeInChunkModeByAFault) {
  open_stream();
  start(true);
  server_.faults().add({.fault = CameraFault::kChunkMode, .on = CameraEvent::kCommand, .value = 1});
  EXPECT_EQ(client_.read(feature::kPayloadSize), kImageBytes + 8 + 3 * 16) << "the command is executed";
  const auto packets = trigger_frame();
  EXPECT_EQ(gvcp::get32(packets.at(0), 8), 4U);
  EXPECT_EQ(packets[0].size(), 20U) << "a leader without geometry";
}

TEST_F(ACameraStream, MayNameAnotherFormatPadItsLinesAndForgetWhereItGoes) {
  open_stream();
  start(true);
  for (const CameraFaultStep& step : {CameraFaultStep{.fault = CameraFault::kOtherFormat},
                                      CameraFaultStep{.fault = CameraFault::kPaddedLines, .value = 4},
                                      CameraFaultStep{.fault = CameraFault::kForgetStream}}) {
    server_.faults().add(step);
  }
  const Bytes other = trigger_frame().at(0);
  EXPECT_EQ(gvcp::get32(other, 20), sensor_format_info(SensorFormat::kBayerRG8).pfnc);
  const auto padded = trigger_frame();
  EXPECT_EQ(gvcp::get32(padded.at(0), 20), sensor_format_info(SensorFormat::kMono8).pfnc);
  EXPECT_EQ(gvcp::get16(padded[0], 40), 4);
  std::size_t bytes = 0;
  for (std::size_t i = 1; i + 1 < padded.size(); ++i) bytes += padded[i].size() - 8;
  EXPECT_EQ(bytes, kImageBytes + 48 * 4);
  EXPECT_EQ(client_.write(feature::kTriggerSoftware, 1), 0);
  const HostTime deadline = HostClock::now() + std::chrono::seconds(20);
  while (client_.read(gvcp::reg::kStreamPort) != 0 && HostClock::now() < deadline) std::this_thread::yield();
  EXPECT_EQ(client_.read(gvcp::reg::kStreamPort), 0U);
}

TEST(CameraFaultConfig, ReadsEveryFieldAndRefusesWhatCannotHappen) {
  const auto steps = read_camera_fault_steps(
      R"([{"fault": "clock_step", "on": "command", "step_ms": -3600000}, {"fault": "pending_ack", "delay_ms": 9, "value": 5}])",
      "script");
  EXPECT_EQ(steps.at(0).step, -std::chrono::hours(1));
  EXPECT_EQ(steps[0].on, CameraEvent::kCommand);
  EXPECT_EQ(steps.at(1).value, 5);
  EXPECT_EQ(camera_fault_names().size(), static_cast<std::size_t>(CameraFault::kForgetStream) + 1);
  for (const auto& name : camera_fault_names()) {
    const auto read =
        read_camera_fault_steps(R"([{"delay_ms": 1, "value": 1, "step_ms": 1, "fault": ")" + name + "\"}]", "script");
    EXPECT_EQ(name_of(read[0].fault), name);
  }
  for (const char* wrong : {R"({"fault": "clock_step"})", R"({"fault": "odd_time"})", R"({"fault": "pending_ack"})",
                            R"({"fault": "padded_lines"})", R"({"fault": "busy", "on": "frame"})",
                            R"({"fault": "odd_time", "step_ms": 86400001})"}) {
    fvd::test::expect_error(ErrorCode::kBadConfig, {"script", "/0"},
                            [&] { (void)read_camera_fault_steps("[" + std::string(wrong) + "]", "script"); });
  }
}

}  // namespace
}  // namespace fvd::sim
