#pragma once

/// A GigE Vision camera on a loopback address: what an unmodified GigE Vision client opens, configures and streams
/// from.

#include <cstdint>
#include <memory>
#include <string>

#include "sim/camera/camera_fault_script.hpp"
#include "sim/world/frame_source.hpp"

namespace fvd::sim {

struct GigeCameraOptions {
  std::string address = "127.0.0.1";  ///< any address of 127.0.0.0/8 works without being set up
  std::string serial = "SIM01";
  double link_mbps = 1000.0;         ///< speed of the line the stream leaves on; 0 = as fast as it goes
  std::uint64_t first_block_id = 1;  ///< of the first frame after AcquisitionStart
  bool extended_ids = false;         ///< block ids of 64 bit, as GigE Vision 2.0 has them
  std::uint64_t seed = 1;            ///< of packet loss
};

/// GVCP: discovery, register and memory access, control privilege with heartbeat, packet resend, timestamp latch, test
/// packets; NACKs as the standard has them. GVSP: all of SensorFormat. Trigger by software or line, or free run at
/// AcquisitionFrameRate; an exposure runs while the image before it is read out and sent. A trigger during an exposure
/// is ignored.
class GigeCameraServer {
 public:
  /// Binds UDP 3956 of the address. Throws Error kBadConfig if it is taken. source outlives the server.
  GigeCameraServer(FrameSource& source, const GigeCameraOptions& options);
  /// Gone without a word, as a camera whose plug was pulled.
  ~GigeCameraServer();

  [[nodiscard]] std::string address() const;
  [[nodiscard]] std::uint64_t frames() const noexcept;          ///< that left, wholly or in part
  [[nodiscard]] std::uint64_t frames_dropped() const noexcept;  ///< because rendering or line could not keep up
  [[nodiscard]] std::uint64_t packets_lost() const noexcept;
  [[nodiscard]] std::uint64_t packets_resent() const noexcept;

  // context: any thread
  /// An edge on the camera's Line0.
  void pulse_line();
  void set_packet_loss(double ratio);  ///< each stream packet, repeated ones too, is lost with this probability
  [[nodiscard]] CameraFaultScript& faults();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A loopback address on which UDP 3956 is free now; every process starts looking at another one, so that several
/// simulated cameras can live on one machine. Throws Error kBadConfig if none is found.
[[nodiscard]] std::string free_camera_address();

}  // namespace fvd::sim
