#include "sim/camera/camera_registers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "sim/camera/genicam_xml.hpp"

namespace fvd::sim {

namespace {

using gvcp::Status;
namespace reg = gvcp::reg;

constexpr std::uint32_t kBootstrapBytes = 0x0E00;
constexpr std::uint32_t kXmlAddress = 0x10000;

std::optional<SensorFormat> format_of(std::uint32_t pfnc) {
  for (const SensorFormat format : kAllSensorFormats) {
    if (sensor_format_info(format).pfnc == pfnc) return format;
  }
  return std::nullopt;
}

std::uint64_t wide_at(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = (value << 8U) | bytes[i];
  return value;
}

}  // namespace

CameraRegisters::CameraRegisters(const CameraIdentity& identity) : identity_(identity) { initialise_locked(); }

void CameraRegisters::reset() {
  const MutexLock lock(mutex_);
  const std::vector<std::uint8_t> before = bootstrap_;
  initialise_locked();
  const auto keep = [&](std::uint32_t address, std::size_t bytes) {
    std::copy_n(before.begin() + address, bytes, bootstrap_.begin() + address);
  };
  keep(reg::kUserName, reg::kUserNameBytes);
  for (const auto address :
       {reg::kStreamSourcePort, reg::kIpConfigCurrent, reg::kIpAddress, reg::kSubnetMask, reg::kGateway,
        reg::kPersistentIpAddress, reg::kPersistentSubnetMask, reg::kPersistentGateway}) {
    keep(address, 4);
  }
}

void CameraRegisters::initialise_locked() {
  const CameraIdentity& identity = identity_;
  bootstrap_.assign(kBootstrapBytes, 0);
  features_.assign(feature::kBytes, 0);
  std::string xml = genicam_xml({.width_increment = identity.width_increment, .chunk_mode = identity.chunk_mode});
  if (identity.edit_description) xml = identity.edit_description(std::move(xml));
  xml_.assign(xml.begin(), xml.end());
  xml_.resize((xml_.size() + 3) / 4 * 4);  // memory is read in multiples of 4

  set_locked(reg::kVersion, 0x00010002);
  set_locked(reg::kDeviceMode, 0x80000001);  // big-endian, UTF-8
  set_locked(reg::kMacHigh, 0x00000200);     // a locally administered address
  set_locked(reg::kMacLow, identity.address);
  set_locked(reg::kIpConfigSupported, gvcp::ip_config::kAll);
  set_locked(reg::kIpConfigCurrent, gvcp::ip_config::kLinkLocal);
  set_locked(reg::kIpAddress, identity.address);
  set_locked(reg::kSubnetMask, 0xFF000000);
  set_text(reg::kManufacturer, identity.vendor);
  set_text(reg::kModel, identity.model);
  set_text(reg::kDeviceVersion, identity.version);
  set_text(reg::kManufacturerInfo, "simulated");
  set_text(reg::kSerial, identity.serial);
  set_text(reg::kUserName, identity.user_name);
  char url[64];
  std::snprintf(url, sizeof(url), "Local:fvd_simulated_camera.xml;%X;%zX", kXmlAddress, xml.size());
  set_text(reg::kFirstUrl, url);
  set_locked(reg::kInterfaces, 1);
  set_locked(reg::kStreamChannels, 1);
  set_locked(reg::kCapability,
             gvcp::capability::kConcatenation | gvcp::capability::kWriteMemory | gvcp::capability::kPacketResend);
  set_locked(reg::kHeartbeatTimeout, 3000);
  set_locked(reg::kTickFrequencyLow, 1000000000);  // ns
  set_locked(reg::kStreamPacketSize, 1500);

  set_locked(feature::kSensorWidth, static_cast<std::uint32_t>(identity.sensor_width));
  set_locked(feature::kSensorHeight, static_cast<std::uint32_t>(identity.sensor_height));
  const int width = identity.sensor_width / identity.width_increment * identity.width_increment;
  set_locked(feature::kWidth, static_cast<std::uint32_t>(width));
  set_locked(feature::kHeight, static_cast<std::uint32_t>(identity.sensor_height));
  set_locked(feature::kPixelFormat, 0x01080001);
  set_float_locked(feature::kExposureTime, 5000.0);
  set_float_locked(feature::kFrameRate, 25.0);
  refresh_payload_locked();
}

std::uint8_t* CameraRegisters::locate(std::uint32_t address, std::size_t count) {
  return const_cast<std::uint8_t*>(std::as_const(*this).locate(address, count));
}

const std::uint8_t* CameraRegisters::locate(std::uint32_t address, std::size_t count) const {
  const auto inside = [&](std::uint32_t base, const std::vector<std::uint8_t>& memory) {
    return address >= base && address - base <= memory.size() && count <= memory.size() - (address - base);
  };
  if (inside(0, bootstrap_)) return bootstrap_.data() + address;
  if (inside(kXmlAddress, xml_)) return xml_.data() + (address - kXmlAddress);
  if (inside(feature::kBase, features_)) return features_.data() + (address - feature::kBase);
  return nullptr;
}

std::uint32_t CameraRegisters::get_locked(std::uint32_t address) const {
  return gvcp::get32(std::span(locate(address, 4), 4), 0);
}

void CameraRegisters::set_locked(std::uint32_t address, std::uint32_t value) {
  std::uint8_t* bytes = locate(address, 4);
  for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (24U - 8U * i));
}

double CameraRegisters::get_float_locked(std::uint32_t address) const {
  return std::bit_cast<double>(wide_at(locate(address, 8)));
}

void CameraRegisters::set_float_locked(std::uint32_t address, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  set_locked(address, static_cast<std::uint32_t>(bits >> 32U));
  set_locked(address + 4, static_cast<std::uint32_t>(bits & 0xFFFFFFFFU));
}

void CameraRegisters::set_text(std::uint32_t address, const std::string& text) {
  std::copy(text.begin(), text.end(), locate(address, text.size()));
}

std::uint32_t CameraRegisters::get(std::uint32_t address) const {
  const MutexLock lock(mutex_);
  return get_locked(address);
}

void CameraRegisters::set(std::uint32_t address, std::uint32_t value) {
  const MutexLock lock(mutex_);
  set_locked(address, value);
  refresh_payload_locked();
}

Status CameraRegisters::read(std::uint32_t address, std::span<std::uint8_t> bytes) const {
  const MutexLock lock(mutex_);
  const std::uint8_t* found = locate(address, bytes.size());
  if (found == nullptr) return Status::kInvalidAddress;
  std::copy_n(found, bytes.size(), bytes.begin());
  return Status::kSuccess;
}

Status CameraRegisters::check_locked(std::uint32_t address, std::span<const std::uint8_t> bytes) const {
  const auto within = [](double value, double min, double max) {
    return value >= min && value <= max ? Status::kSuccess : Status::kInvalidParameter;
  };
  if (bytes.size() == 8 &&
      (address == feature::kExposureTime || address == feature::kGain || address == feature::kFrameRate)) {
    const double value = std::bit_cast<double>(wide_at(bytes.data()));
    if (address == feature::kExposureTime) return within(value, 10.0, 1e7);
    if (address == feature::kGain) return within(value, 0.0, 24.0);
    return within(value, 0.1, kLargestFrameRate_hz);
  }
  if (address >= reg::kUserName && address + bytes.size() <= reg::kUserName + reg::kUserNameBytes) {
    return Status::kSuccess;
  }
  if (bytes.size() != 4) return Status::kWriteProtect;
  const std::uint32_t value = gvcp::get32(bytes, 0);
  const bool locked = get_locked(feature::kParametersLocked) != 0;
  switch (address) {
    case feature::kWidth:
    case feature::kOffsetX:
    case feature::kHeight:
    case feature::kOffsetY: {
      if (locked) return Status::kAccessDenied;
      const bool across = address == feature::kWidth || address == feature::kOffsetX;
      const std::uint32_t sensor = get_locked(across ? feature::kSensorWidth : feature::kSensorHeight);
      const bool is_size = address == feature::kWidth || address == feature::kHeight;
      // The offset is set after the size; what reaches beyond the sensor is refused when the second of them is written.
      const std::uint32_t other = get_locked(is_size ? address + 8 : address - 8);
      const std::uint64_t end = std::uint64_t{value} + other;
      if (across && value % static_cast<std::uint32_t>(identity_.width_increment) != 0)
        return Status::kInvalidParameter;
      return (is_size && value < 1) || end > sensor ? Status::kInvalidParameter : Status::kSuccess;
    }
    case feature::kChunkModeActive:
      if (locked) return Status::kAccessDenied;
      return within(value, 0, 1);
    case feature::kPixelFormat:
      if (locked) return Status::kAccessDenied;
      return format_of(value) ? Status::kSuccess : Status::kInvalidParameter;
    case feature::kAcquisitionMode:
    case feature::kTriggerMode:
    case feature::kFrameRateEnable:
    case feature::kParametersLocked:
    case feature::kTriggerSource:
      return within(value, 0, 1);
    case feature::kTriggerSelector:
      return within(value, 0, 0);
    case feature::kAcquisitionStart:
    case feature::kAcquisitionStop:
    case feature::kTriggerSoftware:
    case reg::kTimestampControl:
    case reg::kControlPrivilege:
    case reg::kStreamPort:
    case reg::kStreamAddress:
    case reg::kPersistentIpAddress:
    case reg::kPersistentSubnetMask:
    case reg::kPersistentGateway:
    case feature::kSpare:
    case feature::kSpare + 4:
    case feature::kSpare + 8:
    case feature::kSpare + 12:
      return Status::kSuccess;
    case reg::kIpConfigCurrent:
      return (value & ~gvcp::ip_config::kAll) == 0 ? Status::kSuccess : Status::kInvalidParameter;
    case reg::kStreamPacketDelay:
      return within(value, 0, kLargestPacketDelay_ns);
    case reg::kHeartbeatTimeout:
      return within(value, 500, 60000);
    case reg::kStreamPacketSize:
      return value % kPacketSizeIncrement != 0 ? Status::kInvalidParameter : within(value & 0xFFFFU, 576, 16000);
    default:
      return locate(address, 4) == nullptr ? Status::kInvalidAddress : Status::kWriteProtect;
  }
}

Status CameraRegisters::write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  const MutexLock lock(mutex_);
  if (address % 4 != 0) return Status::kBadAlignment;
  const Status status = check_locked(address, bytes);
  if (status != Status::kSuccess) return status;
  std::copy(bytes.begin(), bytes.end(), locate(address, bytes.size()));
  if (address == reg::kIpConfigCurrent) {
    set_locked(address, get_locked(address) | gvcp::ip_config::kLinkLocal);
  }
  refresh_payload_locked();
  return status;
}

void CameraRegisters::refresh_payload_locked() {
  const SensorFormat format = format_of(get_locked(feature::kPixelFormat)).value();
  const std::size_t bytes = sensor_image_bytes(format, static_cast<int>(get_locked(feature::kWidth)),
                                               static_cast<int>(get_locked(feature::kHeight)));
  const std::size_t chunks = get_locked(feature::kChunkModeActive) != 0 ? gvsp::chunk_bytes() : 0;
  set_locked(feature::kPayloadSize,
             static_cast<std::uint32_t>(bytes + chunks + static_cast<std::size_t>(identity_.payload_margin_bytes)));
}

CameraState CameraRegisters::state() const {
  const MutexLock lock(mutex_);
  CameraState state;
  state.format = format_of(get_locked(feature::kPixelFormat)).value();
  state.width = static_cast<int>(get_locked(feature::kWidth));
  state.height = static_cast<int>(get_locked(feature::kHeight));
  state.offset_x = static_cast<int>(get_locked(feature::kOffsetX));
  state.offset_y = static_cast<int>(get_locked(feature::kOffsetY));
  state.exposure_us = get_float_locked(feature::kExposureTime);
  state.gain_db = get_float_locked(feature::kGain);
  state.frame_rate_hz = get_float_locked(feature::kFrameRate);
  state.single_frame = get_locked(feature::kAcquisitionMode) != 0;
  state.triggered = get_locked(feature::kTriggerMode) != 0;
  state.by_line = get_locked(feature::kTriggerSource) != 0;
  state.stream_address = get_locked(reg::kStreamAddress);
  state.stream_port = static_cast<int>(get_locked(reg::kStreamPort) & 0xFFFFU);
  state.packet_size = static_cast<int>(get_locked(reg::kStreamPacketSize) & 0xFFFFU);
  state.packet_delay_ns = get_locked(reg::kStreamPacketDelay);
  state.chunks = static_cast<ChunkMode>(get_locked(feature::kChunkModeActive));
  return state;
}

}  // namespace fvd::sim
