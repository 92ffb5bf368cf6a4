#pragma once

/// The frame pool of an Aravis stream: fixed memory that the camera writes into and the measurement reads from.

#include <chrono>
#include <cstddef>

#include <arv.h>

#include "core/image/frame.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

/// Owns the stream and one slab of page-aligned slots. Every buffer holds a reference to the slab, so the memory
/// outlives every writer and reader. Leases must be given back before the pool is destroyed. context: recycle()
/// thread-safe, the rest one thread at a time.
class FrameBuffers final : public FrameRecycler {
 public:
  /// Takes the stream and hands it `count` buffers of `payload_bytes`.
  FrameBuffers(GObjectPtr<ArvStream> stream, int count, std::size_t payload_bytes);
  ~FrameBuffers();
  FrameBuffers(const FrameBuffers&) = delete;
  FrameBuffers& operator=(const FrameBuffers&) = delete;

  /// The next buffer; waits at most `timeout`; nullptr if none came. The caller owns it through lease().
  [[nodiscard]] ArvBuffer* pop(std::chrono::microseconds timeout);
  [[nodiscard]] FrameLease lease(ArvBuffer* buffer) { return {buffer, FrameSlotDeleter{this}}; }
  void recycle(void* slot) noexcept override;

  /// Restarts Aravis' receiving thread, so that smaller block ids are not treated as late ones. Takes about 60 ms.
  void restart_thread();
  /// Number of packets that Aravis discarded as belonging to late frames; 0 for a stream without packets.
  [[nodiscard]] std::uint64_t ignored_packets() const;

  [[nodiscard]] ArvStream* stream() const { return stream_.get(); }

 private:
  GObjectPtr<ArvStream> stream_;
};

}  // namespace fvd
