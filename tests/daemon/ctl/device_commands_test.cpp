/// fvdctl devices and camera set-ip: against a simulated station, and in a network of the test's own.

#include "daemon/ctl/device_commands.hpp"

#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "drivers/gige/gvcp_socket.hpp"
#include "gtest/gtest.h"
#include "sim/plant/plant.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/gvcp_camera.hpp"
#include "tests/support/network_namespace.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using nlohmann::json;
using test::run_command;

TEST(Devices, TellOfACameraAtAnAddressAndOfUnitsThatAnswer) {
  sim::Plant plant({});
  const std::string tcp = "127.0.0.1:" + std::to_string(plant.stage_port());
  const auto run = run_command({"devices", "--json", "--at", plant.camera_address(), "--tcp", tcp, "--units", "1-2"});
  EXPECT_EQ(run.code, kExitOk) << run.err << run.out;
  const json found = json::parse(run.out);
  ASSERT_EQ(found["cameras"].size(), 1U) << run.out;
  EXPECT_EQ(found["cameras"][0]["address"], plant.camera_address());
  EXPECT_EQ(found["cameras"][0]["control"], "free");
  EXPECT_FALSE(found["cameras"][0]["serial"].get<std::string>().empty());
  ASSERT_EQ(found["lines"].size(), 1U);
  EXPECT_FALSE(found["lines"][0]["units"].empty()) << run.out;
  EXPECT_EQ(found["lines"][0]["units"][0]["unit"], 1);
  EXPECT_EQ(plant.drive().moves(), 0);
}

TEST(Devices, TellThatALineCannotBeAsked) {
  const auto run = run_command({"devices", "--at", "127.0.0.253", "--tcp", "127.0.0.1:1", "--units", "1"});
  EXPECT_EQ(run.code, kExitUnavailable);
  EXPECT_NE(run.out.find("none answers"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("cannot open 127.0.0.1:1"), std::string::npos) << run.out;
}

TEST(Devices, RefuseWhatCannotBeMeant) {
  for (const char* units : {"0", "248", "5-4", "a", "1-", "1-2-3"}) {
    const auto run = run_command({"devices", "--at", "127.0.0.1", "--tcp", "127.0.0.1", "--units", units});
    EXPECT_EQ(run.code, kExitUsage) << units;
  }
  EXPECT_EQ(run_command({"devices", "--at", "127.0.0.1", "--tcp", "127.0.0.1"}).code, kExitUsage);
  EXPECT_EQ(run_command({"devices", "--at", "somewhere"}).code, kExitUsage);
  const auto run = run_command({"devices", "--interface", "nosuch0"});
  EXPECT_EQ(run.code, kExitBadData);
  EXPECT_NE(run.err.find("nosuch0"), std::string::npos) << run.err;
}

/// What a command in a network of its own, with a camera at that address, came to; code -1 where there can be none.
struct InOwnNetwork {
  test::Outcome outcome;
  std::uint32_t address = 0;
  std::map<std::uint32_t, std::uint32_t> registers;
};

InOwnNetwork in_own_network(const std::string& camera_address, const std::vector<std::string>& words,
                            const std::function<void(test::GvcpCamera&)>& before = {}) {
  InOwnNetwork result;
  std::thread([&] {  // the namespace ends with this thread
    if (!test::enter_own_network()) return;
    test::GvcpCamera camera(*gvcp::address_of(camera_address));
    if (before) before(camera);
    if (camera.bound()) result.outcome = run_command(words);
    result.address = camera.address();
    for (const std::uint32_t at : {0x0014U, 0x064CU, 0x065CU, 0x066CU, 0x0A00U}) result.registers[at] = camera.reg(at);
  })
      .join();
  return result;
}

#define SKIP_WITHOUT_NETWORK(result) \
  if ((result).outcome.code == -1) GTEST_SKIP() << "no network namespace on this machine"

TEST(Devices, FindACameraByBroadcastAndTellThatItsSubnetDoesNotFit) {
  const auto run = in_own_network("192.168.7.9", {"devices", "--json", "--interface", "lo"});
  SKIP_WITHOUT_NETWORK(run);
  ASSERT_EQ(run.outcome.code, kExitOk) << run.outcome.err;
  const json found = json::parse(run.outcome.out);
  ASSERT_EQ(found["cameras"].size(), 1U) << run.outcome.out;
  const json& camera = found["cameras"][0];
  EXPECT_EQ(camera["vendor"], "Acme");
  EXPECT_EQ(camera["model"], "One");
  EXPECT_EQ(camera["serial"], "SN42");
  EXPECT_EQ(camera["user_name"], "left");
  EXPECT_EQ(camera["firmware"], "1.2.3");
  EXPECT_EQ(camera["mac"], "aa:bb:cc:dd:ee:01");
  EXPECT_EQ(camera["address"], "192.168.7.9");
  EXPECT_EQ(camera["subnet_fits"], false);
  EXPECT_EQ(camera["interface"], "lo");
}

TEST(Devices, TellWhoControlsACamera) {
  const auto run = in_own_network("127.0.0.9", {"devices", "--interface", "lo"}, [](test::GvcpCamera& camera) {
    camera.set_reg(gvcp::kControlPrivilege, 2);
    camera.set_reg(gvcp::kControllerAddress, 0xC0A80102);
    camera.set_reg(gvcp::kControllerPort, 51000);
  });
  SKIP_WITHOUT_NETWORK(run);
  EXPECT_NE(run.outcome.out.find("controlled by 192.168.1.2:51000"), std::string::npos) << run.outcome.out;
}

TEST(Devices, BelieveNoAnswerThatIsTooShort) {
  const auto run = in_own_network("127.0.0.9", {"devices", "--json", "--interface", "lo"},
                                  [](test::GvcpCamera& camera) { camera.answer_too_short(); });
  SKIP_WITHOUT_NETWORK(run);
  EXPECT_EQ(run.outcome.code, kExitOk) << run.outcome.err;
  EXPECT_TRUE(json::parse(run.outcome.out)["cameras"].empty()) << run.outcome.out;
}

TEST(Devices, KeepWhatWasFoundWhereOneAddressCannotBeAsked) {
  const auto run = in_own_network(
      "127.0.0.9", {"devices", "--json", "--interface", "lo", "--at", "203.0.113.9", "--at", "127.0.0.9"});
  SKIP_WITHOUT_NETWORK(run);
  EXPECT_EQ(run.outcome.code, kExitUnavailable) << run.outcome.err;
  EXPECT_EQ(json::parse(run.outcome.out)["cameras"].size(), 2U) << run.outcome.out;
  EXPECT_NE(run.outcome.out.find("203.0.113.9"), std::string::npos) << run.outcome.out;
}

TEST(CameraSetIp, ReachesACameraOfAnotherSubnet) {
  const auto run =
      in_own_network("192.168.7.9", {"camera", "set-ip", "SN42", "--address", "127.0.0.77", "--interface", "lo"});
  SKIP_WITHOUT_NETWORK(run);
  EXPECT_EQ(run.outcome.code, kExitOk) << run.outcome.err;
  EXPECT_EQ(run.address, *gvcp::address_of("127.0.0.77"));
  EXPECT_EQ(run.registers.at(gvcp::kPersistentAddress), 0U) << "nothing for good unasked";
  EXPECT_NE(run.outcome.out.find("--persistent"), std::string::npos) << run.outcome.out;
}

TEST(CameraSetIp, SetsAnAddressForGood) {
  const auto run = in_own_network("192.168.7.9",
                                  {"camera", "set-ip", "left", "--address", "127.0.0.77", "--mask", "255.0.0.0",
                                   "--persistent", "--interface", "lo"},
                                  [](test::GvcpCamera& camera) { camera.set_reg(gvcp::kIpConfiguration, 6); });
  SKIP_WITHOUT_NETWORK(run);
  EXPECT_EQ(run.outcome.code, kExitOk) << run.outcome.err;
  EXPECT_EQ(run.registers.at(gvcp::kPersistentAddress), *gvcp::address_of("127.0.0.77"));
  EXPECT_EQ(run.registers.at(gvcp::kPersistentMask), 0xFF000000U);
  EXPECT_EQ(run.registers.at(gvcp::kIpConfiguration), 7U);
  EXPECT_EQ(run.registers.at(gvcp::kControlPrivilege), 0U) << "control is given back";
}

TEST(CameraSetIp, WaitsForACameraWhoseMemoryIsSlow) {
  const auto run = in_own_network(
      "127.0.0.77", {"camera", "set-ip", "SN42", "--address", "127.0.0.77", "--persistent", "--interface", "lo"},
      [](test::GvcpCamera& camera) { camera.write_slowly(std::chrono::milliseconds(300)); });
  SKIP_WITHOUT_NETWORK(run);
  EXPECT_EQ(run.outcome.code, kExitOk) << run.outcome.err;
  EXPECT_EQ(run.registers.at(gvcp::kPersistentAddress), *gvcp::address_of("127.0.0.77"));
  EXPECT_EQ(run.registers.at(gvcp::kControlPrivilege), 0U) << "control is given back";
}

TEST(CameraSetIp, TakesNoAddressOfAnotherCamera) {
  std::unique_ptr<test::GvcpCamera> neighbour;
  const auto run = in_own_network(
      "192.168.7.9", {"camera", "set-ip", "SN42", "--address", "127.0.0.77", "--interface", "lo"},
      [&neighbour](test::GvcpCamera&) {
        neighbour = std::make_unique<test::GvcpCamera>(*gvcp::address_of("127.0.0.77"), 0xFF000000U, true);
      });
  SKIP_WITHOUT_NETWORK(run);
  EXPECT_EQ(run.outcome.code, kExitBadData) << run.outcome.err;
  EXPECT_NE(run.outcome.err.find("aa:bb:cc:dd:ee:02"), std::string::npos) << run.outcome.err;
  EXPECT_EQ(run.address, *gvcp::address_of("192.168.7.9")) << "nothing was sent";
}

TEST(CameraSetIp, RefusesWhatCannotBeReachedAfterwards) {
  const auto refused = [](const std::vector<std::string>& more) {
    std::vector<std::string> words{"camera", "set-ip", "SN42", "--interface", "lo", "--address"};
    words.insert(words.end(), more.begin(), more.end());
    return in_own_network("192.168.7.9", words);
  };
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"192.168.8.1"}, "not in the subnet of lo"},
      {{"127.0.0.1"}, "is the address of lo"},
      {{"127.0.0.0", "--mask", "255.255.255.0"}, "network's own address"},
      {{"127.0.0.5", "--mask", "255.0.255.0"}, "no mask of a subnet"},
      {{"127.0.0.9", "--gateway", "10.0.0.1"}, "gateway 10.0.0.1 is not in the subnet"},
      {{"224.0.0.1"}, "no address of a device"}};
  for (const auto& [words, text] : cases) {
    const auto run = refused(words);
    SKIP_WITHOUT_NETWORK(run);
    EXPECT_EQ(run.outcome.code, kExitBadData) << run.outcome.err;
    EXPECT_NE(run.outcome.err.find(text), std::string::npos) << run.outcome.err;
    EXPECT_EQ(run.address, *gvcp::address_of("192.168.7.9")) << text;
  }
}

TEST(CameraSetIp, TellsOfACameraThatIsNotThereThatIsControlledThatKeepsItsAddress) {
  const std::vector<std::string> words{"camera", "set-ip", "SN42", "--address", "127.0.0.77", "--interface", "lo"};
  std::vector<std::string> another = words;
  another[2] = "SN43";
  const auto unknown = in_own_network("192.168.7.9", another);
  SKIP_WITHOUT_NETWORK(unknown);
  EXPECT_EQ(unknown.outcome.code, kExitUnavailable);
  EXPECT_NE(unknown.outcome.err.find("found; Acme One, serial SN42"), std::string::npos) << unknown.outcome.err;

  const auto controlled =
      in_own_network("127.0.0.9", words, [](test::GvcpCamera& camera) { camera.set_reg(gvcp::kControlPrivilege, 2); });
  EXPECT_EQ(controlled.outcome.code, kExitJobFailed);
  EXPECT_NE(controlled.outcome.err.find("is controlled by another program"), std::string::npos)
      << controlled.outcome.err;
  EXPECT_EQ(controlled.address, *gvcp::address_of("127.0.0.9"));

  const auto deaf =
      in_own_network("192.168.7.9", words, [](test::GvcpCamera& camera) { camera.be_deaf_to_force_ip(); });
  EXPECT_EQ(deaf.outcome.code, kExitUnavailable);
  EXPECT_NE(deaf.outcome.err.find("does not answer at 127.0.0.77"), std::string::npos) << deaf.outcome.err;
}

TEST(ExitCodes, CallNoRefusalOfADeviceABug) {
  for (const ErrorCode code :
       {ErrorCode::kCameraSettings, ErrorCode::kCameraFramesLost, ErrorCode::kCameraNoFrames, ErrorCode::kFocusRange}) {
    EXPECT_EQ(exit_code(code), kExitJobFailed) << static_cast<int>(code);
  }
}

}  // namespace
}  // namespace fvd::ctl
