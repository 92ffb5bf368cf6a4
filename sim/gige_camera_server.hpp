#pragma once

/// A GigE Vision camera on a loopback address: what an unmodified GigE Vision client opens, configures and streams
/// from.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "sim/frame_source.hpp"

namespace fvd::sim {

struct GigeCameraOptions {
  std::string address = "127.0.0.1";  ///< any address of 127.0.0.0/8 works without being set up
  std::string serial = "SIM01";
  double link_mbps = 1000.0;         ///< speed of the line the stream leaves on
  std::uint16_t first_block_id = 1;  ///< of the first frame after AcquisitionStart
  std::uint64_t seed = 1;            ///< of packet loss
};

/// GVCP: discovery, register and memory access, control privilege with heartbeat, packet resend, timestamp latch; NACKs
/// as the standard has them. GVSP: Mono8, Mono10, Mono12, Mono16. Software trigger, or free run at
/// AcquisitionFrameRate. Control is answered while frames are exposed, rendered and sent. A trigger during an exposure
/// is ignored.
class GigeCameraServer {
 public:
  /// Binds UDP 3956 of the address. Throws Error kBadConfig if it is taken. source outlives the server.
  GigeCameraServer(FrameSource& source, const GigeCameraOptions& options);
  /// Gone without a word, as a camera whose plug was pulled.
  ~GigeCameraServer();

  [[nodiscard]] std::string address() const;
  [[nodiscard]] std::uint64_t frames() const noexcept;
  [[nodiscard]] std::uint64_t packets_lost() const noexcept;
  [[nodiscard]] std::uint64_t packets_resent() const noexcept;

  // Faults. context: any thread.
  void set_packet_loss(double ratio);  ///< each stream packet, repeated ones too, is lost with this probability
  void set_mute(bool mute);            ///< answers nothing and sends nothing
  void drop_frames(int count);         ///< the next frames are never sent and cannot be repeated
  void ignore_triggers(int count);     ///< the next triggers are acknowledged and forgotten
  void repeat_frames(int count);       ///< the next frames are sent twice
  void delay_frames(int count, std::chrono::milliseconds delay);  ///< the next frames leave late
  void cut_frames(int count);                                     ///< the next frames are half as high as configured

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A loopback address on which UDP 3956 is free now; every process starts looking at another one, so that several
/// simulated cameras can live on one machine. Throws Error kBadConfig if none is found.
[[nodiscard]] std::string free_camera_address();

}  // namespace fvd::sim
