#pragma once

/// A GigE Vision camera on a loopback address: what an unmodified GigE Vision client opens, configures and streams
/// from.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "sim/camera/camera_fault_script.hpp"
#include "sim/world/frame_source.hpp"

namespace fvd::sim {

struct GigeCameraOptions {
  std::string address = "127.0.0.1";  ///< any address of 127.0.0.0/8 works without being set up
  std::string serial = "SIM01";
  std::string name{};            ///< user-defined name, at most 15 characters as the serial number
  bool discoverable = false;     ///< answers broadcasts, those on loopback only
  int width_increment = 1;       ///< pixels, > 0; widths and offsets across are multiples of it
  bool chunk_mode = false;       ///< ChunkModeActive is described; some clients take that for features of chunks
  int payload_margin_bytes = 0;  ///< >= 0; added to PayloadSize, for chunks and padded lines that come unannounced
  std::function<std::string(std::string)> edit_description{};  ///< changes the GenICam XML, if set
  double link_mbps = 1000.0;                                   ///< speed of the stream's line, Mbit/s; 0 = unlimited
  std::uint64_t first_block_id = 1;                            ///< of the first frame after AcquisitionStart
  bool extended_ids = false;                                   ///< block ids of 64 bit, as in GigE Vision 2.0
  std::uint64_t seed = 1;                                      ///< seed of the packet loss
};

/// GVCP: discovery, FORCEIP, register and memory access, control privilege with heartbeat, packet resend, timestamp
/// latch, test packets; NACKs as in the standard. GVSP: all of SensorFormat. Trigger by software or line, or free run
/// at AcquisitionFrameRate; an exposure runs while the image before it is read out and sent. A trigger during an
/// exposure is ignored.
class GigeCameraServer {
 public:
  /// Binds UDP 3956 of the address. Throws Error kBadConfig if it is taken or a name is too
  /// long. source outlives the server.
  GigeCameraServer(FrameSource& source, const GigeCameraOptions& options);
  /// Disappears without a message, like a camera whose plug was pulled.
  ~GigeCameraServer();

  /// A client may change it.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] std::uint64_t frames() const noexcept;          ///< frames sent, wholly or in part
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

/// A loopback address on which UDP 3956 is free now. Every process starts its search at another address, so that
/// several simulated cameras can run on one machine. Throws Error kBadConfig if none is found.
[[nodiscard]] std::string free_camera_address();

}  // namespace fvd::sim
