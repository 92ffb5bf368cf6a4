#pragma once

/// Memory for slices that are converted from the bytes on the wire.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/image/frame.hpp"

namespace fvd {

/// A fixed number of slots of one size. Leases must be given back before the pool is destroyed. context: thread-safe.
class SlicePool final : public FrameRecycler {
 public:
  SlicePool(int count, std::size_t slot_bytes);

  /// An empty lease if all slots are lent.
  [[nodiscard]] FrameLease borrow();
  /// The memory of a lease of this pool.
  [[nodiscard]] std::span<std::byte> bytes(const FrameLease& lease) const {
    return {static_cast<std::byte*>(lease.get()), slot_bytes_};
  }
  void recycle(void* slot) noexcept override;

 private:
  std::size_t slot_bytes_;
  std::unique_ptr<std::byte[]> memory_;
  Mutex mutex_;
  std::vector<void*> free_ FVD_GUARDED_BY(mutex_);  // never above the capacity it was made with
};

}  // namespace fvd
