#pragma once

/// The frame pool of an Aravis stream: fixed memory that the camera writes into and the measurement reads from.

#include <chrono>
#include <cstddef>

#include <arv.h>

#include "core/image/frame.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

/// Owns the stream and one slab of page-aligned slots. Every buffer holds the slab, so the memory outlives whoever
/// still writes to it or reads from it. Leases are given back before the pool goes.
class FrameBuffers final : public FrameRecycler {
 public:
  /// Takes the stream and hands it `count` buffers of `payload_bytes`.
  FrameBuffers(GObjectPtr<ArvStream> stream, int count, std::size_t payload_bytes);
  ~FrameBuffers();
  FrameBuffers(const FrameBuffers&) = delete;
  FrameBuffers& operator=(const FrameBuffers&) = delete;

  /// The next buffer, waiting at most that long; nullptr if there is none. The caller owns it through lease().
  [[nodiscard]] ArvBuffer* pop(std::chrono::microseconds timeout);
  [[nodiscard]] FrameLease lease(ArvBuffer* buffer) { return {buffer, FrameSlotDeleter{this}}; }
  void recycle(void* slot) noexcept override;

  /// Forgets the numbers of the frames received so far, so that smaller ones are not taken for late. Some 60 ms.
  void restart_thread();
  /// Packets that Aravis threw away as belonging to late frames; 0 where there are no packets.
  [[nodiscard]] std::uint64_t ignored_packets() const;

  [[nodiscard]] ArvStream* stream() const { return stream_.get(); }

 private:
  GObjectPtr<ArvStream> stream_;
};

}  // namespace fvd
