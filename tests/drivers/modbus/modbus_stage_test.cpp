/// The Modbus driver against the simulated drive: real sockets, real protocol.

#include <cmath>
#include <memory>
#include <thread>

#include "core/base/error.hpp"
#include "drivers/modbus/modbus_axis.hpp"
#include "drivers/modbus/modbus_link.hpp"
#include "gtest/gtest.h"
#include "sim/axis/axis_model.hpp"
#include "sim/drives/az_drive.hpp"
#include "sim/modbus/modbus_tcp_server.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;

class AModbusStage : public testing::Test {
 protected:
  explicit AModbusStage(const sim::AxisParameters& parameters = chapter()) : axis_(parameters), drive_(axis_) {
    serve();
  }

  static sim::AxisParameters chapter() {
    sim::AxisParameters parameters;
    parameters.settle_noise_um = 0.02;
    parameters.encoder_noise_um = 0.01;
    parameters.start_latency_ms = 3.0;
    return parameters;
  }

  void serve() {
    server_ = std::make_unique<sim::ModbusTcpServer>(drive_, sim::ModbusTcpOptions{.port = port_});
    port_ = server_->port();
  }

  [[nodiscard]] std::unique_ptr<Axis> open() const {
    StageConfig config;
    config.profile = FVD_SOURCE_DIR "/config/drives/oriental-az.json";
    config.port = port_;
    config.min = Micrometers{-300.0};
    config.max = Micrometers{300.0};
    return open_modbus_stage(config);
  }

  [[nodiscard]] std::unique_ptr<Axis> open_homed() const {
    auto stage = open();
    stage->home({});
    return stage;
  }

  template <typename Action>
  static ErrorCode error_of(Action action, std::string* message = nullptr) {
    try {
      action();
    } catch (const Error& error) {
      if (message != nullptr) *message = error.what();
      return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::kInternal;
  }

  static double seconds_of(const std::function<void()>& action) {
    const auto begin = HostClock::now();
    action();
    return std::chrono::duration<double>(HostClock::now() - begin).count();
  }

  SettleCriterion criterion_{
      .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(10), .timeout = milliseconds(2000)};
  sim::AxisModel axis_;
  sim::AzDrive drive_;
  int port_ = 0;
  std::unique_ptr<sim::ModbusTcpServer> server_;
};

TEST_F(AModbusStage, HomesAndStepsToSettledPositionsMeasuredTrue) {
  auto stage = open();
  EXPECT_FALSE(stage->status().homed);
  stage->home({});
  EXPECT_TRUE(stage->status().homed);
  EXPECT_NEAR(axis_.true_position_um(HostClock::now()), 0.0, 0.1);
  int samples = 0;
  for (int i = 0; i < 10; ++i) {
    const Micrometers target{-7.0 + 10.0 * i};
    const MoveRecord move = stage->move_to(target, criterion_, {});
    EXPECT_LE(std::abs(move.position.value - target.value), 0.5);
    EXPECT_EQ(move.target_counts.value, static_cast<int>(std::lround(target.value * 100)));
    const HostTime now = HostClock::now();
    const PositionMean mean = stage->mean_position(now, now + milliseconds(6));
    samples += mean.samples;  // a loaded machine may leave one window without
    EXPECT_NEAR(mean.mean.value, axis_.true_position_um(now), 0.05);
  }
  EXPECT_GT(samples, 0);
}

TEST_F(AModbusStage, RefusesTargetsOutsideItsLimitsAndMovesNothing) {
  auto stage = open_homed();
  std::string message;
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{301.0}, criterion_, {}); }, &message), ErrorCode::kStageLimit);
  EXPECT_NE(message.find("301"), std::string::npos);
  EXPECT_NE(message.find("-300..300"), std::string::npos) << message;
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{1e12}, criterion_, {}); }), ErrorCode::kStageLimit);
  EXPECT_EQ(drive_.moves(), 0);
}

TEST_F(AModbusStage, RefusesToMoveBeforeItIsHomed) {
  auto stage = open();
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{1.0}, criterion_, {}); }), ErrorCode::kStageNotHomed);
  EXPECT_EQ(drive_.moves(), 0);
}

TEST_F(AModbusStage, ReportsAnAlarmWithItsText) {
  auto stage = open_homed();
  drive_.raise_alarm(0x30);
  std::string message;
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{1.0}, criterion_, {}); }, &message), ErrorCode::kStageAlarm);
  EXPECT_NE(message.find("0x30: overload"), std::string::npos) << message;
}

TEST_F(AModbusStage, EndsAnAlarmWhenItIsTold) {
  auto stage = open_homed();
  stage->reset_alarm({});  // there is none
  drive_.raise_alarm(0x30);
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{1.0}, criterion_, {}); }), ErrorCode::kStageAlarm);
  const int moves = drive_.moves();
  stage->reset_alarm({});
  EXPECT_FALSE(stage->status().alarm);
  EXPECT_EQ(drive_.moves(), moves) << "a reset moves nothing";
}

TEST_F(AModbusStage, SaysThatAnAlarmStandsWhoseCauseStands) {
  auto stage = open_homed();
  drive_.keep_alarms();
  drive_.raise_alarm(0x30);
  std::string message;
  EXPECT_EQ(error_of([&] { stage->reset_alarm({}); }, &message), ErrorCode::kStageAlarm);
  EXPECT_NE(message.find("0x30: overload"), std::string::npos) << message;
  EXPECT_TRUE(stage->status().alarm);
}

TEST_F(AModbusStage, ReportsAnAlarmThatComesInMotion) {
  auto stage = open_homed();
  std::jthread fault([this] {
    while (!axis_.moving(HostClock::now())) std::this_thread::yield();
    drive_.raise_alarm(0x10);
  });
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{250.0}, criterion_, {}); }), ErrorCode::kStageAlarm);
}

TEST_F(AModbusStage, ReportsAMoveThatIsSilentlyRefused) {
  auto stage = open_homed();
  drive_.refuse_moves(1);
  std::string message;
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{50.0}, criterion_, {}); }, &message), ErrorCode::kStagePosition);
  EXPECT_NE(message.find("does not move"), std::string::npos) << message;
}

TEST_F(AModbusStage, HaltsOnAStopRequestInMotion) {
  auto stage = open_homed();
  std::stop_source stop;
  std::jthread operator_thread([&] {
    while (!axis_.moving(HostClock::now())) std::this_thread::yield();
    stop.request_stop();
  });
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{290.0}, criterion_, stop.get_token()); }), ErrorCode::kAborted);
  EXPECT_LT(stage->status().position.value, 280.0);
}

TEST_F(AModbusStage, StopsFromAnotherThreadInMotion) {
  auto stage = open_homed();
  std::jthread operator_thread([&] {
    while (!axis_.moving(HostClock::now())) std::this_thread::yield();
    stage->stop();
  });
  criterion_.timeout = milliseconds(600);
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{290.0}, criterion_, {}); }), ErrorCode::kStagePosition);
}

TEST_F(AModbusStage, GivesUpSoonOnADriveThatStopsAnswering) {
  auto stage = open_homed();
  server_->set_mute(true);
  const double seconds = seconds_of([&] {
    EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{50.0}, criterion_, {}); }), ErrorCode::kStageDisconnected);
  });
  EXPECT_LT(seconds, 2.5);
  EXPECT_FALSE(stage->connected());
  EXPECT_EQ(error_of([&] { (void)stage->status(); }), ErrorCode::kStageDisconnected);
  EXPECT_LT(seconds_of([&] { stage.reset(); }), 2.5);
}

TEST_F(AModbusStage, WorksAgainOnceTheDriveIsBack) {
  auto stage = open_homed();
  server_.reset();
  EXPECT_EQ(error_of([&] { (void)stage->move_to(Micrometers{5.0}, criterion_, {}); }), ErrorCode::kStageDisconnected);
  stage.reset();  // one at a time has the drive
  EXPECT_EQ(error_of([&] { (void)open(); }), ErrorCode::kStageDisconnected);
  serve();
  auto again = open();
  EXPECT_TRUE(again->status().homed) << "the drive kept its reference";
  EXPECT_NO_THROW(again->move_to(Micrometers{5.0}, criterion_, {}));
}

TEST_F(AModbusStage, DoesNotRepeatAMoveWhoseReplyWasLost) {
  auto stage = open_homed();
  server_->lose_write_replies(1);
  const MoveRecord move = stage->move_to(Micrometers{40.0}, criterion_, {});
  EXPECT_NEAR(move.position.value, 40.0, 0.5);
  EXPECT_EQ(drive_.moves(), 1);
}

TEST_F(AModbusStage, RepeatsAMoveThatNeverArrivedOnce) {
  auto stage = open_homed();
  server_->lose_writes(1);
  EXPECT_NEAR(stage->move_to(Micrometers{40.0}, criterion_, {}).position.value, 40.0, 0.5);
  EXPECT_EQ(drive_.moves(), 1);
  server_->lose_writes(2);
  EXPECT_EQ(error_of([&] { stage->move_to(Micrometers{80.0}, criterion_, {}); }), ErrorCode::kStageDisconnected);
  EXPECT_EQ(drive_.moves(), 1);
}

TEST_F(AModbusStage, SurvivesALateReplyWithoutMixingValues) {
  auto stage = open_homed();
  stage->move_to(Micrometers{20.0}, criterion_, {});
  server_->delay_replies(1, milliseconds(260));
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(stage->status().position.value, 20.0, 0.5);
  EXPECT_TRUE(stage->connected());
}

TEST(ModbusLink, SaysWhatItCouldNotReach) {
  try {
    const ModbusLink link({ModbusTcpEndpoint{"127.0.0.1", 1}, 1, milliseconds(200)});
    FAIL() << "connected to nothing";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kStageDisconnected);
    EXPECT_NE(std::string(error.what()).find("127.0.0.1:1"), std::string::npos);
  }
}

TEST_F(AModbusStage, TellsExceptionsFromLostReplies) {
  ModbusLink link({ModbusTcpEndpoint{"127.0.0.1", port_}, 1, milliseconds(200)});
  EXPECT_EQ(link.read(ModbusTable::kHolding, 0x1000, 2).outcome, ModbusOutcome::kRejected);
  EXPECT_EQ(link.read(ModbusTable::kHolding, 0x007E, 80).outcome, ModbusOutcome::kOk);
  EXPECT_EQ(link.stats().reconnects, 0U) << "an exception is no reason to reconnect";
  ModbusLink wrong_unit({ModbusTcpEndpoint{"127.0.0.1", port_}, 7, milliseconds(50)});
  EXPECT_EQ(wrong_unit.read(ModbusTable::kHolding, 0x007E, 2).outcome, ModbusOutcome::kUnknown)
      << "another unit's request gets no answer";
}

TEST_F(AModbusStage, ServesTwoClientsAtOnce) {
  auto stage = open_homed();
  ModbusLink other({ModbusTcpEndpoint{"127.0.0.1", port_}, 1, milliseconds(200)});
  for (int i = 0; i < 50; ++i) EXPECT_EQ(other.read(ModbusTable::kHolding, 0x00CC, 2).outcome, ModbusOutcome::kOk);
  EXPECT_NO_THROW(stage->move_to(Micrometers{3.0}, criterion_, {}));
}

}  // namespace
}  // namespace fvd
