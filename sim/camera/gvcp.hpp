#pragma once

/// The GigE Vision control protocol as bytes: commands, status codes, bootstrap registers (GigE Vision 1.2).
/// All numbers on the wire are big-endian.

#include <cstdint>
#include <span>
#include <vector>

namespace fvd::sim::gvcp {

inline constexpr int kPort = 3956;
inline constexpr std::size_t kHeaderBytes = 8;
inline constexpr std::size_t kMaxPayload = 540;

enum class Command : std::uint16_t {
  kDiscovery = 0x0002,
  kForceIp = 0x0004,
  kPacketResend = 0x0040,
  kReadRegister = 0x0080,
  kWriteRegister = 0x0082,
  kReadMemory = 0x0084,
  kWriteMemory = 0x0086,
};

enum class Status : std::uint16_t {
  kSuccess = 0x0000,
  kNotImplemented = 0x8001,
  kInvalidParameter = 0x8002,
  kInvalidAddress = 0x8003,
  kWriteProtect = 0x8004,
  kBadAlignment = 0x8005,
  kAccessDenied = 0x8006,
  kBusy = 0x8007,
};

/// The message, not an answer, that announces when the answer will come.
inline constexpr std::uint16_t kPendingAcknowledge = 0x0089;

/// Bootstrap registers the server gives a meaning to.
namespace reg {
inline constexpr std::uint32_t kVersion = 0x0000;
inline constexpr std::uint32_t kDeviceMode = 0x0004;
inline constexpr std::uint32_t kMacHigh = 0x0008;
inline constexpr std::uint32_t kMacLow = 0x000C;
inline constexpr std::uint32_t kIpConfigSupported = 0x0010;
inline constexpr std::uint32_t kIpConfigCurrent = 0x0014;
inline constexpr std::uint32_t kIpAddress = 0x0024;
inline constexpr std::uint32_t kSubnetMask = 0x0034;
inline constexpr std::uint32_t kGateway = 0x0044;
inline constexpr std::uint32_t kManufacturer = 0x0048;
inline constexpr std::uint32_t kModel = 0x0068;
inline constexpr std::uint32_t kDeviceVersion = 0x0088;
inline constexpr std::uint32_t kManufacturerInfo = 0x00A8;
inline constexpr std::uint32_t kSerial = 0x00D8;
inline constexpr std::uint32_t kUserName = 0x00E8;
inline constexpr std::size_t kUserNameBytes = 16;
inline constexpr std::uint32_t kDiscoveryBytes = 0x00F8;
inline constexpr std::uint32_t kFirstUrl = 0x0200;
inline constexpr std::uint32_t kInterfaces = 0x0600;
inline constexpr std::uint32_t kPersistentIpAddress = 0x064C;
inline constexpr std::uint32_t kPersistentSubnetMask = 0x065C;
inline constexpr std::uint32_t kPersistentGateway = 0x066C;
inline constexpr std::uint32_t kStreamChannels = 0x0904;
inline constexpr std::uint32_t kCapability = 0x0934;
inline constexpr std::uint32_t kHeartbeatTimeout = 0x0938;
inline constexpr std::uint32_t kTickFrequencyHigh = 0x093C;
inline constexpr std::uint32_t kTickFrequencyLow = 0x0940;
inline constexpr std::uint32_t kTimestampControl = 0x0944;
inline constexpr std::uint32_t kTimestampHigh = 0x0948;
inline constexpr std::uint32_t kTimestampLow = 0x094C;
inline constexpr std::uint32_t kControlPrivilege = 0x0A00;
inline constexpr std::uint32_t kPrimaryPort = 0x0A04;     // of the controller
inline constexpr std::uint32_t kPrimaryAddress = 0x0A14;  // of the controller
inline constexpr std::uint32_t kStreamPort = 0x0D00;
inline constexpr std::uint32_t kStreamPacketSize = 0x0D04;
inline constexpr std::uint32_t kStreamPacketDelay = 0x0D08;
inline constexpr std::uint32_t kStreamAddress = 0x0D18;
inline constexpr std::uint32_t kStreamSourcePort = 0x0D1C;
}  // namespace reg

namespace capability {
inline constexpr std::uint32_t kConcatenation = 1U << 0U;
inline constexpr std::uint32_t kWriteMemory = 1U << 1U;
inline constexpr std::uint32_t kPacketResend = 1U << 2U;
}  // namespace capability

namespace ip_config {
inline constexpr std::uint32_t kPersistent = 1U << 0U;
inline constexpr std::uint32_t kDhcp = 1U << 1U;
inline constexpr std::uint32_t kLinkLocal = 1U << 2U;  ///< always on
inline constexpr std::uint32_t kAll = kPersistent | kDhcp | kLinkLocal;
}  // namespace ip_config

namespace privilege {
inline constexpr std::uint32_t kExclusive = 1U << 0U;  ///< others may not even read
inline constexpr std::uint32_t kControl = 1U << 1U;
}  // namespace privilege

inline constexpr std::uint32_t kFireTestPacket = 1U << 31U;
inline constexpr std::uint32_t kLatchTimestamp = 1U << 1U;

[[nodiscard]] inline std::uint16_t get16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}
[[nodiscard]] inline std::uint32_t get32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return (static_cast<std::uint32_t>(get16(bytes, at)) << 16U) | get16(bytes, at + 2);
}
inline void put16(std::vector<std::uint8_t>& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>((value >> 8U) & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
}
inline void put32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  put16(bytes, value >> 16U);
  put16(bytes, value & 0xFFFFU);
}

}  // namespace fvd::sim::gvcp
