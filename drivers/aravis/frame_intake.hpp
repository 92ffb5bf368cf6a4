#pragma once

/// Converts the buffers of a stream to frames: checks, counts, dates and unpacks them. Inside the driver only: this
/// header includes Aravis.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <arv.h>

#include "core/hw/camera.hpp"
#include "drivers/aravis/camera_clock.hpp"
#include "drivers/aravis/frame_buffers.hpp"
#include "drivers/aravis/frame_counter.hpp"
#include "drivers/aravis/slice_pool.hpp"

namespace fvd {

/// context: not thread-safe; the threads that use it take turns.
class FrameIntake {
 public:
  /// The clock outlives the intake.
  explicit FrameIntake(CameraClock& clock) : clock_(clock) {}

  /// To be called for a new stream with these settings: the camera restarts its block ids, slices may have another
  /// shape.
  void begin_stream(const CameraSettings& in_force);
  /// To be called when the camera has restarted its block ids on the same stream.
  void restart_count() { counter_.restart(); }

  /// Why the last frame was refused that was complete; empty if none was since forget_refusal().
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  void forget_refusal() { refusal_.clear(); }

  /// The frame of a buffer; nothing for a frame exposed before `configured`, with other settings. The buffer goes back
  /// with the frame's lease. A frame that is dated in the future makes the clock doubtful.
  [[nodiscard]] std::optional<Frame> take(FrameBuffers& buffers, ArvBuffer* buffer, const CameraSettings& in_force,
                                          HostTime configured);
  /// Counts a frame that is not measured and gives its buffer back. Returns its time on the camera's clock in ns, 0 if
  /// the frame is incomplete or of the wrong geometry.
  std::uint64_t discard(FrameBuffers& buffers, ArvBuffer* buffer, const CameraSettings& in_force);

  /// Adds the counters of this object to health.
  void count_into(CameraHealth& health) const;

 private:
  void count_id(std::uint64_t block_id, Frame& frame);
  [[nodiscard]] bool misdated(Frame& frame);
  [[nodiscard]] bool unpack_into_slice(const CameraSettings& in_force, std::span<const std::byte> image, Frame& frame);

  CameraClock& clock_;
  FrameCounter counter_;
  std::unique_ptr<SlicePool> slices_;  // nothing: slices are what comes over the wire
  std::string refusal_;
  std::uint64_t frames_complete_ = 0;
  std::uint64_t frames_failed_ = 0;
  std::uint64_t failed_since_good_ = 0;
  std::uint64_t ids_skipped_ = 0;
  std::uint64_t slice_underruns_ = 0;
};

}  // namespace fvd
