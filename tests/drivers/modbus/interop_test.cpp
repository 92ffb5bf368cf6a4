/// The driver and the simulator against programs that are not fvd's: pymodbus' server, mbpoll, and modbus-serial both
/// as a drive and as a client.

#include "gtest/gtest.h"
#include "tests/support/child_process.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::Transport;

/// Drives a server that prints its port; package: what to install where it does not start.
void drive_a_hundred_steps(test::ChildProcess& server, const std::string& package) {
  const std::string port = server.line();
  ASSERT_FALSE(port.empty() || port.find_first_not_of("0123456789") != std::string::npos)
      << port << server.rest() << "; install " << package << ", as tests/run.sh does";
  StageConfig config;
  config.profile = FVD_SOURCE_DIR "/config/drives/oriental-az.json";
  config.port = std::stoi(port);
  config.min = Micrometers{-100.0};
  config.max = Micrometers{1100.0};
  const auto stage = open_modbus_stage(config);
  stage->home({});
  const SettleCriterion criterion{
      .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(5), .timeout = milliseconds(5000)};
  for (int i = 1; i <= 100; ++i) {
    const MoveRecord move = stage->move_to(Micrometers{10.0 * i}, criterion, {});
    ASSERT_DOUBLE_EQ(move.position.value, 10.0 * i);
  }
  const auto stats = stage->link_stats();
  EXPECT_EQ(stats->refused, 0U);
  EXPECT_EQ(stats->implausible, 0U);
  EXPECT_LE(stats->unanswered, 5U);  // of a thousand: on a busy machine a server waits for its turn
}

TEST(ThePymodbusServer, IsDrivenAHundredSteps) {
  test::ChildProcess server({"/usr/bin/python3", FVD_SOURCE_DIR "/tests/drivers/modbus/pymodbus_az.py"});
  drive_a_hundred_steps(server, "python3-pymodbus");
}

constexpr const char* kScripts = FVD_SOURCE_DIR "/tests/drivers/modbus/javascript/";

/// The stack is installed from a package registry, which not every machine reaches.
bool has_modbus_serial() {
  test::ChildProcess probe({"node", "-e", "require('" + std::string(kScripts) + "node_modules/modbus-serial')"});
  (void)probe.rest();
  return probe.wait() == 0;
}
constexpr const char* kNoModbusSerial = "modbus-serial of npm is not there; tests/run.sh installs it";

TEST(TheModbusSerialServer, IsDrivenAHundredSteps) {
  if (!has_modbus_serial()) GTEST_SKIP() << kNoModbusSerial;
  test::ChildProcess server({"node", std::string(kScripts) + "az_drive.js"});
  drive_a_hundred_steps(server, "nodejs");
}

TEST(TheModbusSerialClient, IdentifiesAndMovesTheSimulatedDrive) {
  if (!has_modbus_serial()) GTEST_SKIP() << kNoModbusSerial;
  test::SimulatedDrive plant(test::kDriveCases[4], Transport::kTcp);
  const ModbusLinkConfig link = plant.line().config();
  const auto& tcp = std::get<ModbusTcpEndpoint>(link.endpoint);
  test::ChildProcess client({"node", std::string(kScripts) + "client.js", std::to_string(tcp.port)});
  const std::string seen = client.rest();
  EXPECT_EQ(client.wait(), 0) << seen;
  EXPECT_EQ(seen,
            "identity fvd, simulated CiA 402 drive, 1.0\n"
            "no such register 2\nno such coil 2\nno such object 2\nmoved\n");
}

class Mbpoll : public testing::TestWithParam<Transport> {
 protected:
  /// What the README tells a user to type, against this line.
  [[nodiscard]] std::vector<std::string> command(int register_address) const {
    std::vector<std::string> words{"mbpoll", "-0",    "-1", "-q", "-a", "1", "-r", std::to_string(register_address),
                                   "-t",     "4:int", "-B"};
    const ModbusLinkConfig link = plant_.line().config();
    if (const auto* serial = std::get_if<ModbusSerialEndpoint>(&link.endpoint)) {
      for (const char* word : {"-m", "rtu", "-b", "115200", "-P", "even"}) words.emplace_back(word);
      words.push_back(serial->device);
    } else {
      const auto& tcp = std::get<ModbusTcpEndpoint>(link.endpoint);
      for (const std::string& word : {std::string("-p"), std::to_string(tcp.port), tcp.host}) words.push_back(word);
    }
    return words;
  }

  mutable test::SimulatedDrive plant_{test::kDriveCases[0], GetParam()};
};

TEST_P(Mbpoll, ReadsAndWritesTheSimulatedDrive) {
  constexpr int kTarget = 0x5C;
  auto write = command(kTarget);
  write.emplace_back("123456");
  test::ChildProcess writing(write);
  const std::string written = writing.rest();
  ASSERT_EQ(writing.wait(), 0) << written << "; install mbpoll, as tests/run.sh does";
  test::ChildProcess reading(command(kTarget));
  const std::string read = reading.rest();
  EXPECT_EQ(reading.wait(), 0) << read;
  EXPECT_NE(read.find("[92]: \t123456"), std::string::npos) << read;
}

TEST_P(Mbpoll, IsToldOfAnAddressThatIsNone) {
  test::ChildProcess reading(command(0xF000));
  const std::string read = reading.rest();
  EXPECT_NE(reading.wait(), 0);
  EXPECT_NE(read.find("Illegal data address"), std::string::npos) << read;
}

INSTANTIATE_TEST_SUITE_P(On, Mbpoll, testing::Values(Transport::kTcp, Transport::kRtu),
                         [](const auto& on) { return testing::PrintToString(on.param); });

}  // namespace
}  // namespace fvd
