#include "drivers/aravis/frame_buffers.hpp"

#include <cstdlib>
#include <memory>
#include <new>

namespace fvd {

namespace {

constexpr std::size_t kPageBytes = 4096;

struct FreeDeleter {
  void operator()(void* memory) const { std::free(memory); }
};

/// What a buffer keeps alive.
struct SlotTag {
  std::shared_ptr<void> slab;
};

}  // namespace

FrameBuffers::FrameBuffers(GObjectPtr<ArvStream> stream, int count, std::size_t payload_bytes)
    : stream_(std::move(stream)) {
  const std::size_t slot = (payload_bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
  std::shared_ptr<void> slab(std::aligned_alloc(kPageBytes, slot * static_cast<std::size_t>(count)), FreeDeleter{});
  if (!slab) throw std::bad_alloc();
  for (int i = 0; i < count; ++i) {
    auto* memory = static_cast<std::byte*>(slab.get()) + slot * static_cast<std::size_t>(i);
    arv_stream_push_buffer(stream_.get(), arv_buffer_new_full(payload_bytes, memory, new SlotTag{slab},
                                                              [](gpointer tag) { delete static_cast<SlotTag*>(tag); }));
  }
}

FrameBuffers::~FrameBuffers() = default;

ArvBuffer* FrameBuffers::pop(std::chrono::microseconds timeout) {
  if (timeout.count() <= 0) return arv_stream_try_pop_buffer(stream_.get());
  return arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(timeout.count()));
}

void FrameBuffers::restart_thread() {
  arv_stream_stop_thread(stream_.get(), FALSE);
  arv_stream_start_thread(stream_.get());
}

std::uint64_t FrameBuffers::ignored_packets() const {
  return arv_stream_get_info_uint64_by_name(stream_.get(), "n_ignored_packets");
}

void FrameBuffers::recycle(void* slot) noexcept {
  arv_stream_push_buffer(stream_.get(), static_cast<ArvBuffer*>(slot));
}

}  // namespace fvd
