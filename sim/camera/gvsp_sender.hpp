#pragma once

/// Sends the packets of frames at the speed of a line, and repeats them on request.

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <random>
#include <span>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "sim/camera/gvsp.hpp"

namespace fvd::sim {

/// Which packets of a frame leave now.
struct Sending {
  bool leader = true;
  bool trailer = true;
  bool reordered = false;     ///< payload in reverse, eight packets at a time
  std::uint32_t without = 0;  ///< a payload packet that does not leave, 0 = none
};

/// Packets first..last of a block, to be sent again.
struct ResendRequest {
  std::uint64_t block_id = 0;
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  bool extended_ids = false;
  std::uint32_t to_address = 0;  ///< IPv4, host order: who is told of packets that are not there
  int to_port = 0;
};

/// context: send() from the readout thread, resend() from the control thread, the rest from any.
class GvspSender {
 public:
  /// Binds a socket of its own to the camera's address (IPv4, host order). link_mbps: rate at which packets leave, as
  /// on a real line, Mbit/s; 0 = unlimited, which overruns the receiver's buffer. Throws Error kBadConfig.
  GvspSender(std::uint32_t address, double link_mbps, std::uint64_t seed);
  ~GvspSender();
  GvspSender(const GvspSender&) = delete;
  GvspSender& operator=(const GvspSender&) = delete;

  /// Goes on from another address, and another port; false, and all stays, if it cannot be had.
  [[nodiscard]] bool move_to(std::uint32_t address);
  [[nodiscard]] int source_port() const { return source_port_; }
  void set_packet_loss(double ratio) { packet_loss_ = ratio; }
  [[nodiscard]] std::uint64_t packets_lost() const { return packets_lost_; }
  [[nodiscard]] std::uint64_t packets_resent() const { return packets_resent_; }

  /// Sends the frame and keeps it for repetition.
  void send(const std::shared_ptr<const StreamFrame>& frame, const Sending& what);
  /// Sends the leader alone; its frame is not there yet.
  void send_leader(const StreamFrame& frame);
  /// Repeats packets of a block that is still kept. For each of the first 256 that cannot be had any more a packet goes
  /// out that says so.
  void resend(const ResendRequest& request);
  /// One packet of exactly `size` bytes on the wire, unless it would have to be fragmented.
  void send_test_packet(std::uint32_t to_address, int to_port, int size);
  /// A frame to which nothing else refers, to be filled anew; an empty frame if there is none.
  [[nodiscard]] std::shared_ptr<StreamFrame> spare();
  /// Forgets the frames kept.
  void forget();

 private:
  static constexpr std::size_t kKeptFrames = 4;

  void send_unavailable(const ResendRequest& request, std::span<const std::uint32_t> packets);
  void transmit(const StreamFrame& frame, std::span<const std::uint32_t> packets);
  [[nodiscard]] bool lose_packet();

  int socket_;
  std::atomic<int> source_port_{0};
  int mtu_;
  double bytes_per_second_;
  std::atomic<double> packet_loss_{0.0};
  std::atomic<std::uint64_t> packets_lost_{0};
  std::atomic<std::uint64_t> packets_resent_{0};
  Mutex mutex_;
  std::deque<std::shared_ptr<const StreamFrame>> kept_ FVD_GUARDED_BY(mutex_);
  std::shared_ptr<const StreamFrame> spare_ FVD_GUARDED_BY(mutex_);
  std::mt19937_64 random_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd::sim
