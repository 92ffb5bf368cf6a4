#pragma once

/// Transport of a GigE Vision camera's packets: packet size, receive buffer, timeouts. Inside the driver only: this
/// header includes Aravis.

#include <chrono>

#include <arv.h>

#include "drivers/aravis/camera_features.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// Largest packet size that is requested: no network card accepts and no camera sends larger ones.
inline constexpr int kLargestPacket_bytes = 16000;

/// MTU in bytes of the interface towards the camera; 1500, and a warning in the log, if it cannot be determined.
[[nodiscard]] int interface_mtu(ArvGvDevice* device);

/// Sets GevSCPSPacketSize: the configured one, or with 0 the largest that comes through in test packets; never above
/// the interface's MTU. Packet delay and socket kind likewise as configured. Returns the size.
/// Throws Error kCameraSettings, kCameraDisconnected.
int set_packet_size(ArvCamera* camera, const CameraFeatures& features, const CameraConfig& config);

/// Times of a frame, from which the timeouts of a stream's packets are computed.
struct StreamTimes {
  std::chrono::microseconds exposure;
  std::chrono::microseconds readout;   ///< from the end of an exposure to the last packet
  std::chrono::microseconds deadline;  ///< from the start of an exposure until a frame counts as missing
};

/// Sets receive buffer, frame retention and packet timeout. A camera may send the leader when the exposure begins, so
/// the timeouts are at least as long as an exposure; frames are delivered in order, so none is kept beyond the
/// deadline.
void set_stream_options(ArvStream* stream, const StreamTimes& times);

/// Warns in the log, once per process, if the system's limits are too low for a camera at full rate.
void warn_of_system_limits(bool packet_socket);

}  // namespace fvd
