#pragma once

/// The memory of the simulated camera: bootstrap registers, its GenICam XML, and its features.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/image/sensor_format.hpp"
#include "sim/camera/gvcp.hpp"
#include "sim/camera/gvsp.hpp"

namespace fvd::sim {

/// Registers behind the features of the XML. Widths in the XML: 4 bytes, floats 8.
namespace feature {
inline constexpr std::uint32_t kBase = 0x20000;
inline constexpr std::uint32_t kWidth = kBase + 0x00;
inline constexpr std::uint32_t kHeight = kBase + 0x04;
inline constexpr std::uint32_t kOffsetX = kBase + 0x08;
inline constexpr std::uint32_t kOffsetY = kBase + 0x0C;
inline constexpr std::uint32_t kSensorWidth = kBase + 0x10;
inline constexpr std::uint32_t kSensorHeight = kBase + 0x14;
inline constexpr std::uint32_t kPixelFormat = kBase + 0x18;
inline constexpr std::uint32_t kPayloadSize = kBase + 0x1C;
inline constexpr std::uint32_t kAcquisitionStart = kBase + 0x20;
inline constexpr std::uint32_t kAcquisitionStop = kBase + 0x24;
inline constexpr std::uint32_t kAcquisitionMode = kBase + 0x28;
inline constexpr std::uint32_t kTriggerMode = kBase + 0x2C;
inline constexpr std::uint32_t kTriggerSource = kBase + 0x30;
inline constexpr std::uint32_t kTriggerSelector = kBase + 0x34;
inline constexpr std::uint32_t kTriggerSoftware = kBase + 0x38;
inline constexpr std::uint32_t kFrameRateEnable = kBase + 0x3C;
inline constexpr std::uint32_t kExposureTime = kBase + 0x40;  // float64, us
inline constexpr std::uint32_t kGain = kBase + 0x48;          // float64, dB
inline constexpr std::uint32_t kFrameRate = kBase + 0x50;     // float64, Hz
inline constexpr std::uint32_t kParametersLocked = kBase + 0x58;
inline constexpr std::uint32_t kChunkModeActive = kBase + 0x5C;
inline constexpr std::uint32_t kSpare = kBase + 0x60;  // 4 words that take any value, for features of tests
inline constexpr std::uint32_t kBytes = 0x70;
}  // namespace feature

inline constexpr double kLargestFrameRate_hz = 5000.0;
inline constexpr std::uint32_t kLargestPacketDelay_ns = 1'000'000;
inline constexpr std::uint32_t kPacketSizeIncrement = 4;  // bytes

/// The settings in the camera's registers.
struct CameraState {
  SensorFormat format = SensorFormat::kMono8;
  int width = 0;
  int height = 0;
  int offset_x = 0;
  int offset_y = 0;
  double exposure_us = 0.0;
  double gain_db = 0.0;
  double frame_rate_hz = 0.0;
  bool single_frame = false;  ///< AcquisitionMode SingleFrame, else Continuous
  bool triggered = false;
  bool by_line = false;              ///< TriggerSource Line0, else Software
  std::uint32_t stream_address = 0;  ///< IPv4, host order; 0 = nobody listens
  int stream_port = 0;
  int packet_size = 0;  ///< bytes on the wire: IP, UDP and GVSP headers included
  std::uint32_t packet_delay_ns = 0;
  ChunkMode chunks = ChunkMode::kOff;
};

struct CameraIdentity {
  std::string vendor = "fvd";
  std::string model = "SimulatedCamera";
  std::string version = "1.0";
  std::string serial = "SIM01";        ///< at most 15 characters
  std::string user_name{};             ///< at most 15 characters
  std::uint32_t address = 0x7F000001;  ///< IPv4, host order
  int sensor_width = 0;
  int sensor_height = 0;
  int width_increment = 1;       ///< pixels; widths and offsets across are multiples of it
  bool chunk_mode = false;       ///< the description has ChunkModeActive; the register is there anyway
  int payload_margin_bytes = 0;  ///< added to PayloadSize
  std::function<std::string(std::string)> edit_description{};  ///< changes the GenICam XML, if set
};

/// context: thread-safe.
class CameraRegisters {
 public:
  explicit CameraRegisters(const CameraIdentity& identity);

  /// Reads bytes.size() bytes. kInvalidAddress outside the memory.
  [[nodiscard]] gvcp::Status read(std::uint32_t address, std::span<std::uint8_t> bytes) const;
  /// Writes with the checks a camera makes: unknown and read-only registers, ranges, parameters locked while acquiring.
  [[nodiscard]] gvcp::Status write(std::uint32_t address, std::span<const std::uint8_t> bytes);

  /// Restores the initial values, except what a camera keeps without power: its name and its ways to an address; nor is
  /// the address it has now changed.
  void reset();

  [[nodiscard]] std::uint32_t get(std::uint32_t address) const;
  void set(std::uint32_t address, std::uint32_t value);
  [[nodiscard]] CameraState state() const;

 private:
  [[nodiscard]] std::uint32_t get_locked(std::uint32_t address) const FVD_REQUIRES(mutex_);
  [[nodiscard]] double get_float_locked(std::uint32_t address) const FVD_REQUIRES(mutex_);
  void set_locked(std::uint32_t address, std::uint32_t value) FVD_REQUIRES(mutex_);
  void set_float_locked(std::uint32_t address, double value) FVD_REQUIRES(mutex_);
  void set_text(std::uint32_t address, const std::string& text) FVD_REQUIRES(mutex_);
  void initialise_locked() FVD_REQUIRES(mutex_);
  void refresh_payload_locked() FVD_REQUIRES(mutex_);
  [[nodiscard]] gvcp::Status check_locked(std::uint32_t address, std::span<const std::uint8_t> bytes) const
      FVD_REQUIRES(mutex_);
  // The analysis does not see that the const one, which this calls, is of the same object.
  [[nodiscard]] std::uint8_t* locate(std::uint32_t address, std::size_t count)
      FVD_REQUIRES(mutex_) FVD_NO_THREAD_SAFETY_ANALYSIS;
  [[nodiscard]] const std::uint8_t* locate(std::uint32_t address, std::size_t count) const FVD_REQUIRES(mutex_);

  const CameraIdentity identity_;
  mutable Mutex mutex_;
  std::vector<std::uint8_t> bootstrap_ FVD_GUARDED_BY(mutex_);
  std::vector<std::uint8_t> xml_ FVD_GUARDED_BY(mutex_);
  std::vector<std::uint8_t> features_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd::sim
