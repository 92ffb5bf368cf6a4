#pragma once

/// How a GigE Vision camera's packets travel: their size, the receive buffer, how long a lost one is waited for. Inside
/// the driver only: this header brings in Aravis.

#include <chrono>

#include <arv.h>

#include "drivers/aravis/camera_features.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// The largest packet a camera is asked for: larger ones no network card takes, and no camera sends.
inline constexpr int kLargestPacket_bytes = 16000;

/// Size of the packets on the wire that the interface towards the camera lets through unfragmented; 1500 where that
/// cannot be found out. Warns if it cannot.
[[nodiscard]] int interface_mtu(ArvGvDevice* device);

/// Sets GevSCPSPacketSize: the configured one, or with 0 the largest that comes through in test packets; never above
/// the interface's MTU. Packet delay and socket kind likewise as configured. Returns the size.
/// Throws Error kCameraSettings, kCameraDisconnected.
int set_packet_size(ArvCamera* camera, const CameraFeatures& features, const CameraConfig& config);

/// Times of a stream's packets, made of the times of a frame.
struct StreamTimes {
  std::chrono::microseconds exposure;
  std::chrono::microseconds readout;   ///< from the end of an exposure to the last packet
  std::chrono::microseconds deadline;  ///< from the start of an exposure until a frame counts as missing
};

/// Receive buffer, frame retention and packet timeout. The camera may begin a frame with its exposure, so what waits
/// for packets waits at least as long; frames are delivered in order, so none is kept beyond the deadline.
void set_stream_options(ArvStream* stream, const StreamTimes& times);

/// Warns, once for the process, where the system does not allow what a camera at full rate needs.
void warn_of_system_limits(bool packet_socket);

}  // namespace fvd
