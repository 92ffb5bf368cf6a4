#pragma once

/// The GigE Vision stream protocol: an image as leader, payload and trailer packets, and their repetition on request.

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <random>
#include <vector>

#include "core/hw/clock.hpp"

namespace fvd::sim {

/// One image ready to be sent.
struct StreamFrame {
  std::uint16_t block_id = 0;  ///< 1..65535
  std::uint64_t timestamp_ns = 0;
  std::uint32_t pfnc = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t offset_x = 0;
  std::uint32_t offset_y = 0;
  std::vector<std::byte> pixels;

  std::uint32_t to_address = 0;  ///< IPv4, host order
  int to_port = 0;
  int packet_size = 1500;  ///< IP, UDP and GVSP headers included
};

/// context: send() from the streaming thread, resend() from the control thread, the rest from any.
class GvspSender {
 public:
  /// Binds a socket of its own to the camera's address. link_mbps: the speed packets leave at, as on the real wire;
  /// a burst at memory speed overruns every receiver's buffer. Throws Error kBadConfig.
  GvspSender(std::uint32_t address, double link_mbps, std::uint64_t seed);
  ~GvspSender();
  GvspSender(const GvspSender&) = delete;
  GvspSender& operator=(const GvspSender&) = delete;

  [[nodiscard]] int source_port() const { return source_port_; }
  void set_packet_loss(double ratio) { packet_loss_ = ratio; }
  [[nodiscard]] std::uint64_t packets_lost() const { return packets_lost_; }
  [[nodiscard]] std::uint64_t packets_resent() const { return packets_resent_; }

  /// Sends the frame and keeps it for repetition.
  void send(std::shared_ptr<const StreamFrame> frame);
  /// Repeats packets first..last of a block that is still kept.
  void resend(std::uint16_t block_id, std::uint32_t first, std::uint32_t last);
  /// One packet of exactly `size` bytes on the wire.
  void send_test_packet(std::uint32_t to_address, int to_port, int size);

 private:
  static constexpr std::size_t kKept = 4;

  void transmit(const StreamFrame& frame, std::uint32_t first, std::uint32_t last);
  [[nodiscard]] bool lose_packet();

  int socket_;
  int source_port_ = 0;
  double bytes_per_second_;
  std::atomic<double> packet_loss_{0.0};
  std::atomic<std::uint64_t> packets_lost_{0};
  std::atomic<std::uint64_t> packets_resent_{0};
  std::mutex mutex_;
  std::deque<std::shared_ptr<const StreamFrame>> kept_;  // this and random_: guarded by mutex_
  std::mt19937_64 random_;
};

}  // namespace fvd::sim
