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
/// In an acknowledge's place: it comes within the time told.
inline constexpr std::uint16_t kPendingAck = 0x0089;

/// Statuses of an acknowledge.
inline constexpr std::uint16_t kAccessDenied = 0x8006;
inline constexpr std::uint16_t kBusy = 0x8007;

/// Flags of a command.
inline constexpr std::uint8_t kAcknowledged = 0x01;
inline constexpr std::uint8_t kAcknowledgedToEverybody =
    0x10;  ///< discovery, FORCEIP: the only way from another subnet

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

/// The bytes of a command.
[[nodiscard]] std::vector<std::uint8_t> command(std::uint16_t code, std::uint8_t flags, std::uint16_t request,
                                                std::span<const std::uint8_t> payload);

struct Acknowledge {
  std::uint16_t status = 0;   ///< 0 = done; else as GigE Vision numbers refusals
  std::uint16_t code = 0;     ///< that of the command + 1, or kPendingAck
  std::uint16_t request = 0;  ///< id of the command
  std::vector<std::uint8_t> payload;

  /// Of kPendingAck: so long from now on the camera asks to be waited for.
  [[nodiscard]] std::chrono::milliseconds pending() const;
};
/// Nothing for what is too short to be one.
[[nodiscard]] std::optional<Acknowledge> acknowledge_of(std::span<const std::uint8_t> datagram);

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

  /// The next acknowledge of that request, of any if it is 0; nothing if none came by `until`, or as much later as
  /// PENDING_ACKs of the request say. All else is passed over. What waits already is read after `until` too, but no
  /// flood of it.
  [[nodiscard]] std::optional<gvcp::Acknowledge> receive(std::uint16_t command, std::uint16_t request,
                                                         std::chrono::steady_clock::time_point until);

  /// One register; nothing if it is not told. This and write_register() ask up to three times, and anew for two seconds
  /// while the camera is busy.
  [[nodiscard]] std::optional<std::uint32_t> read_register(std::uint32_t camera, std::uint32_t address);
  /// Throws Error kCameraSettings if the camera refuses, kCameraDisconnected if it does not answer.
  void write_register(std::uint32_t camera, std::uint32_t address, std::uint32_t value);

 private:
  [[nodiscard]] std::optional<gvcp::Acknowledge> ask(std::uint32_t camera, std::uint16_t command,
                                                     std::span<const std::uint8_t> payload);
  [[nodiscard]] bool send_datagram(std::uint32_t to, std::span<const std::uint8_t> bytes);

  int fd_ = -1;
  const std::uint32_t local_;
  const int interface_index_;
  std::uint16_t last_request_ = 0;
};

}  // namespace fvd
