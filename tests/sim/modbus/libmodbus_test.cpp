/// The lines as libmodbus sees them, with a drive behind.

#include <array>
#include <cerrno>
#include <memory>

#include <modbus/modbus.h>

#include "gtest/gtest.h"
#include "sim/drives/az_drive.hpp"
#include "sim/modbus/modbus_rtu_server.hpp"
#include "sim/modbus/modbus_tcp_server.hpp"
#include "tests/sim/modbus/modbus_requests.hpp"

namespace fvd::sim {
namespace {

using std::chrono::milliseconds;
using Context = std::unique_ptr<modbus_t, decltype(&modbus_free)>;

class LibmodbusOnALine : public testing::TestWithParam<bool> {
 protected:
  LibmodbusOnALine() {
    if (GetParam()) {
      serial_ = std::make_unique<ModbusRtuServer>(drive_, ModbusRtuOptions{.faults = &script_, .drive = &drive_});
    } else {
      tcp_ = std::make_unique<ModbusTcpServer>(drive_, ModbusTcpOptions{.faults = &script_, .drive = &drive_});
    }
  }

  [[nodiscard]] Context connect() const {
    Context context(GetParam() ? modbus_new_rtu(serial_->path().c_str(), 115200, 'E', 8, 1)
                               : modbus_new_tcp("127.0.0.1", tcp_->port()),
                    &modbus_free);
    modbus_set_slave(context.get(), 1);
    modbus_set_response_timeout(context.get(), 0, 200'000);
    EXPECT_EQ(modbus_connect(context.get()), 0) << modbus_strerror(errno);
    return context;
  }

  static void close(const Context& context) { modbus_close(context.get()); }

  static int read(const Context& context, int address, int count) {
    std::array<std::uint16_t, 125> values{};
    errno = 0;
    return modbus_read_registers(context.get(), address, count, values.data()) == count ? values[1] : -1;
  }

  static bool send_to(const Context& context, int target) {
    const auto words = test::words_of({0, 1, target, 100000, 2000000, 2000000, 1000, 1, 0});
    return modbus_write_registers(context.get(), 0x0058, 18, words.data()) == 18;
  }

  AxisModel axis_{AxisParameters{}};
  AzDrive drive_{axis_};
  FaultScript script_;
  std::unique_ptr<ModbusTcpServer> tcp_;
  std::unique_ptr<ModbusRtuServer> serial_;
};

TEST_P(LibmodbusOnALine, ReadsAndWrites) {
  auto context = connect();
  EXPECT_EQ(modbus_write_register(context.get(), 0x0201, 77), 1);
  EXPECT_EQ(read(context, 0x0200, 2), 77);
  std::array<std::uint16_t, 2> values{};
  const std::array<std::uint16_t, 1> written{78};
  EXPECT_EQ(modbus_write_and_read_registers(context.get(), 0x0201, 1, written.data(), 0x0200, 2, values.data()), 2);
  EXPECT_EQ(values[1], 78);
  EXPECT_EQ(modbus_read_input_registers(context.get(), 0x0200, 2, values.data()), 2);
  EXPECT_EQ(read(context, 0x0400, 2), -1);
  EXPECT_EQ(errno, EMBXILADD);
  close(context);
  context = connect();
  EXPECT_EQ(read(context, 0x0200, 2), 78) << "closed and opened again";
  close(context);
}

TEST_P(LibmodbusOnALine, SeesTheFaultsOfTheLine) {
  script_.add({.fault = FaultKind::kLostReply});
  auto context = connect();
  EXPECT_EQ(read(context, 0x00CC, 2), -1);
  EXPECT_EQ(errno, ETIMEDOUT);
  script_.add({.fault = FaultKind::kWrongCrc});
  EXPECT_EQ(read(context, 0x00CC, 2), -1);
  EXPECT_EQ(errno, GetParam() ? EMBBADCRC : EMBBADDATA);
  script_.add({.fault = FaultKind::kException, .code = 6});
  EXPECT_EQ(read(context, 0x00CC, 2), -1);
  EXPECT_EQ(errno, EMBXSBUSY);
  EXPECT_GE(read(context, 0x00CC, 2), 0);
  EXPECT_EQ(script_.describe_unconsumed(), "");
  close(context);
}

TEST_P(LibmodbusOnALine, SeesAnAlarmThatComesInMotion) {
  script_.add({.on = FaultOn::kRead, .fault = FaultKind::kAlarmInMotion, .code = 0x30});
  auto context = connect();
  EXPECT_EQ(read(context, 0x0080, 2), 0) << "at rest";
  ASSERT_TRUE(send_to(context, 100000));
  const auto deadline = HostClock::now() + std::chrono::seconds(10);
  int alarm = 0;
  while (alarm == 0 && HostClock::now() < deadline) alarm = read(context, 0x0080, 2);
  EXPECT_EQ(alarm, 0x30);
  EXPECT_EQ(script_.unconsumed(), 0U);
  close(context);
}

TEST_P(LibmodbusOnALine, SeesADriveThatRefusesWithoutAWordAndOneThatRestarts) {
  script_.add({.on = FaultOn::kWrite, .address = 0x0066, .fault = FaultKind::kSilentRefusal});
  auto context = connect();
  ASSERT_TRUE(send_to(context, 1000)) << "acknowledged";
  EXPECT_EQ(drive_.moves(), 0);
  ASSERT_TRUE(send_to(context, 1000));
  EXPECT_EQ(drive_.moves(), 1);
  EXPECT_EQ(modbus_write_register(context.get(), 0x0201, 77), 1);
  script_.add({.fault = FaultKind::kPowerCycle});
  EXPECT_EQ(read(context, 0x0200, 2), -1);
  close(context);
  context = connect();
  EXPECT_EQ(read(context, 0x0200, 2), 0) << "what was written is gone";
  close(context);
}

INSTANTIATE_TEST_SUITE_P(Lines, LibmodbusOnALine, testing::Bool(),
                         [](const auto& line) { return line.param ? "Serial" : "Tcp"; });

}  // namespace
}  // namespace fvd::sim
