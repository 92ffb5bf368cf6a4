#include "drivers/aravis/slice_pool.hpp"

namespace fvd {

SlicePool::SlicePool(int count, std::size_t slot_bytes)
    : slot_bytes_((slot_bytes + 15) / 16 * 16),
      memory_(std::make_unique<std::byte[]>(slot_bytes_ * static_cast<std::size_t>(count))) {
  for (int i = 0; i < count; ++i) free_.push_back(memory_.get() + slot_bytes_ * static_cast<std::size_t>(i));
}

FrameLease SlicePool::borrow() {
  const MutexLock lock(mutex_);
  if (free_.empty()) return FrameLease(nullptr, FrameSlotDeleter{this});
  void* slot = free_.back();
  free_.pop_back();
  return {slot, FrameSlotDeleter{this}};
}

void SlicePool::recycle(void* slot) noexcept {
  const MutexLock lock(mutex_);
  free_.push_back(slot);
}

}  // namespace fvd
