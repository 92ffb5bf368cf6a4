#pragma once

/// One exposure as the camera delivered it. The pixels live in the camera's pool; the frame gives its slot back when it
/// dies.

#include <cstdint>
#include <memory>

#include "core/base/clock.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// Owner of the slots that frames borrow. Outlives every frame it lent.
class FrameRecycler {
 public:
  /// Takes a slot back. context: thread-safe; never waits for a device.
  virtual void recycle(void* slot) noexcept = 0;

 protected:
  ~FrameRecycler() = default;
};

struct FrameSlotDeleter {
  FrameRecycler* owner = nullptr;
  void operator()(void* slot) const noexcept {
    if (owner != nullptr) owner->recycle(slot);
  }
};
/// Sole right to a slot of a camera's pool.
using FrameLease = std::unique_ptr<void, FrameSlotDeleter>;

enum class FrameStatus {
  kOk,             ///< complete, of the configured geometry
  kIncomplete,     ///< packets missing, timed out or cut short; the pixels must not be read
  kWrongGeometry,  ///< complete but not of the configured format or size
  kMisdated,       ///< complete, but its exposure seems to end in the future: the camera's clock was set anew
};

/// context: one thread at a time; it may be handed to another thread.
struct Frame {
  FrameStatus status = FrameStatus::kIncomplete;
  ImageView image;            ///< valid while the lease is held and status is kOk
  std::uint64_t id = 0;       ///< camera's block id, unwrapped to 64 bit; meaningless unless kOk
  HostTime exposure_start{};  ///< camera time mapped to the host clock; meaningless unless kOk
  HostTime exposure_end{};
  FrameLease lease;
};

}  // namespace fvd
