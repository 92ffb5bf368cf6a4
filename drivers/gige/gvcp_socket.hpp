#pragma once

/// Single questions of the GigE Vision control protocol, without Aravis and without control of the camera.

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fvd {

namespace gvcp {

/// Commands; an acknowledge has the number after its command's.
inline constexpr std::uint16_t kDiscovery = 0x0002;
inline constexpr std::uint16_t kForceIp = 0x0004;
inline constexpr std::uint16_t kReadRegister = 0x0080;
inline constexpr std::uint16_t kWriteRegister = 0x0082;

inline constexpr std::uint32_t kIpConfiguration = 0x0014;
inline constexpr std::uint32_t kPersistentAddress = 0x064C;
inline constexpr std::uint32_t kPersistentMask = 0x065C;
inline constexpr std::uint32_t kPersistentGateway = 0x066C;
inline constexpr std::uint32_t kControlPrivilege = 0x0A00;
inline constexpr std::uint32_t kControllerPort = 0x0A04;     // GigE Vision 2.0
inline constexpr std::uint32_t kControllerAddress = 0x0A14;  // likewise

[[nodiscard]] inline std::uint32_t get32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return (std::uint32_t{bytes[at]} << 24U) | (std::uint32_t{bytes[at + 1]} << 16U) |
         (std::uint32_t{bytes[at + 2]} << 8U) | bytes[at + 3];
}
void put32(std::vector<std::uint8_t>& bytes, std::uint32_t value);

/// "192.168.10.20" of an address in the host's order, and back; nothing for what is no dotted quad.
[[nodiscard]] std::string address_text(std::uint32_t address);
[[nodiscard]] std::optional<std::uint32_t> address_of(const std::string& text);

}  // namespace gvcp

/// A datagram socket that sends through one interface. It hears answers to everybody too, which is all that a camera
/// of another subnet can send. context: one thread.
class GvcpSocket {
 public:
  /// local: an address of this machine in the host's order, and the index of its interface; 0 = as the route says.
  /// Throws Error kCameraDisconnected.
  explicit GvcpSocket(std::uint32_t local = 0, int interface_index = 0);
  ~GvcpSocket();
  GvcpSocket(const GvcpSocket&) = delete;
  GvcpSocket& operator=(const GvcpSocket&) = delete;

  /// Sends a command to port 3956 of an address, 255.255.255.255 for everybody on the wire. Returns its request id.
  /// flags: bit 0 asks for an acknowledge, bit 4 allows it to be a broadcast (discovery, FORCEIP). Throws Error
  /// kCameraDisconnected if it cannot be sent.
  std::uint16_t send(std::uint32_t to, std::uint16_t command, std::uint8_t flags,
                     std::span<const std::uint8_t> payload);

  struct Acknowledge {
    std::uint32_t from = 0;    ///< address of the sender, host's order
    std::uint16_t status = 0;  ///< 0 = done; else as GigE Vision numbers refusals, e.g. 0x8006 access denied
    std::vector<std::uint8_t> payload;
  };
  /// The next acknowledge of that request, of any if it is 0; nothing if none came in time. All else is passed over.
  [[nodiscard]] std::optional<Acknowledge> receive(std::uint16_t command, std::uint16_t request,
                                                   std::chrono::steady_clock::time_point until);

  /// One register, asked for up to three times; nothing if it is not told.
  [[nodiscard]] std::optional<std::uint32_t> read_register(std::uint32_t camera, std::uint32_t address);
  /// Throws Error kCameraSettings if the camera refuses, kCameraDisconnected if it does not answer.
  void write_register(std::uint32_t camera, std::uint32_t address, std::uint32_t value);

 private:
  [[nodiscard]] bool send_datagram(std::uint32_t to, std::span<const std::uint8_t> bytes);

  int fd_ = -1;
  const std::uint32_t local_;
  const int interface_index_;
  std::uint16_t last_request_ = 0;
};

}  // namespace fvd
