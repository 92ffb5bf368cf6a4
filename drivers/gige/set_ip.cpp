#include "drivers/gige/set_ip.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "core/base/error.hpp"
#include "drivers/gige/gvcp_socket.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t kEverybody = 0xFFFFFFFFU;
constexpr std::uint32_t kPersistent = 0x1;
constexpr std::uint32_t kControl = 0x2;
constexpr int kAttempts = 10;
constexpr milliseconds kPatience{500};

std::array<std::uint8_t, 6> mac_of(const std::string& text) {
  std::array<std::uint8_t, 6> mac{};
  for (std::size_t i = 0; i < mac.size() && text.size() == 17; ++i) {
    std::from_chars(text.data() + 3 * i, text.data() + 3 * i + 2, mac[i], 16);
  }
  return mac;
}

/// GigE Vision's layout: two bytes of nothing before the MAC, and twelve before each address.
std::vector<std::uint8_t> force_ip_payload(const FoundCamera& camera, const CameraAddress& wanted) {
  std::vector<std::uint8_t> payload(2, 0);
  for (const std::uint8_t byte : mac_of(camera.mac)) payload.push_back(byte);
  for (const std::uint32_t value : {wanted.address, wanted.mask, wanted.gateway}) {
    payload.resize(payload.size() + 12, 0);
    gvcp::put32(payload, value);
  }
  return payload;
}

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::kBadInput, what); }

/// Holds control of a camera for as long as it lives.
class Control {
 public:
  Control(GvcpSocket& socket, std::uint32_t camera) : socket_(socket), camera_(camera) {
    socket_.write_register(camera_, gvcp::kControlPrivilege, kControl);
  }
  ~Control() {
    try {
      socket_.write_register(camera_, gvcp::kControlPrivilege, 0);
    } catch (const Error&) {
      // Its heartbeat takes the control back within some seconds.
    }
  }
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

 private:
  GvcpSocket& socket_;
  const std::uint32_t camera_;
};

void write_and_read_back(GvcpSocket& socket, std::uint32_t camera, std::uint32_t address, std::uint32_t value) {
  socket.write_register(camera, address, value);
  const auto read = socket.read_register(camera, address);
  if (read == value) return;
  throw Error(ErrorCode::kCameraSettings, "the camera at " + gvcp::address_text(camera) + " was given " +
                                              gvcp::address_text(value) + " and reads back " +
                                              (read ? gvcp::address_text(*read) : std::string("nothing")));
}

}  // namespace

void check_address(const CameraAddress& wanted, const NetworkInterface& interface) {
  const std::string text = gvcp::address_text(wanted.address);
  const std::uint32_t hosts = ~wanted.mask;
  if ((hosts & (hosts + 1U)) != 0 || wanted.mask == 0 || hosts < 3) {
    refuse(gvcp::address_text(wanted.mask) + " is no mask of a subnet; expected e.g. 255.255.255.0");
  }
  const std::uint32_t first = wanted.address >> 24U;
  const bool loopback = (interface.address >> 24U) == 127U;
  if (first == 0 || first >= 224 || (first == 127 && !loopback)) refuse(text + " is no address of a device");
  if ((wanted.address & hosts) == 0 || (wanted.address & hosts) == hosts) {
    refuse(text + " is the network's own address or its broadcast with the mask " + gvcp::address_text(wanted.mask));
  }
  if (wanted.gateway != 0 && (wanted.gateway & wanted.mask) != (wanted.address & wanted.mask)) {
    refuse("the gateway " + gvcp::address_text(wanted.gateway) + " is not in the subnet of " + text +
           " with the mask " + gvcp::address_text(wanted.mask));
  }
  if (wanted.address == interface.address) refuse(text + " is the address of " + interface.name + " of this machine");
  if ((wanted.address & interface.mask) != (interface.address & interface.mask) ||
      (wanted.address & wanted.mask) != (interface.address & wanted.mask)) {
    refuse(text + " with the mask " + gvcp::address_text(wanted.mask) + " is not in the subnet of " + interface.name +
           ", which has " + gvcp::address_text(interface.address) + " with " + gvcp::address_text(interface.mask) +
           "; the camera could not be reached there");
  }
}

void force_ip(const FoundCamera& camera, const CameraAddress& wanted, const NetworkInterface& interface) {
  check_address(wanted, interface);
  if (camera.control == CameraControl::kControlled) {
    throw Error(ErrorCode::kCameraSettings, "the camera " + camera.serial + " at " + camera.address +
                                                " is controlled by " +
                                                (camera.controller.empty() ? "another program" : camera.controller) +
                                                " and keeps its address; stop that first");
  }
  const auto holder = identify_camera(wanted.address, kPatience / 2);
  if (holder && holder->mac != camera.mac) {
    refuse(gvcp::address_text(wanted.address) + " is taken by another camera: " + holder->text());
  }
  GvcpSocket socket(interface.address, interface.index);
  const auto payload = force_ip_payload(camera, wanted);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::uint16_t request =
        socket.send(kEverybody, gvcp::kForceIp, gvcp::kAcknowledged | gvcp::kAcknowledgedToEverybody, payload);
    // The acknowledge may come from either address or not at all; the camera at its new address is what counts.
    (void)socket.receive(gvcp::kForceIp, request, std::chrono::steady_clock::now() + kPatience / 2);
    const auto there = discover_camera_at(wanted.address, kPatience / 2);
    if (there && there->mac == camera.mac) return;
  }
  throw Error(ErrorCode::kCameraDisconnected, "the camera " + camera.serial + " (" + camera.mac +
                                                  ") does not answer at " + gvcp::address_text(wanted.address) +
                                                  "; is another device there, or does a switch drop broadcasts?");
}

void set_persistent_ip(std::uint32_t at, const CameraAddress& wanted) {
  GvcpSocket socket;
  const Control control(socket, at);
  write_and_read_back(socket, at, gvcp::kPersistentAddress, wanted.address);
  write_and_read_back(socket, at, gvcp::kPersistentMask, wanted.mask);
  write_and_read_back(socket, at, gvcp::kPersistentGateway, wanted.gateway);
  const auto configuration = socket.read_register(at, gvcp::kIpConfiguration);
  if (!configuration) {
    throw Error(ErrorCode::kCameraSettings,
                "the camera at " + gvcp::address_text(at) + " does not tell how it comes by its address");
  }
  write_and_read_back(socket, at, gvcp::kIpConfiguration, *configuration | kPersistent);
}

}  // namespace fvd
