#include "drivers/aravis/frame_intake.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/image/unpack.hpp"
#include "drivers/aravis/frame_check.hpp"

namespace fvd {

namespace {

/// Largest error of the camera's clock on the host's while an exposure is compared with the change of settings.
constexpr std::chrono::microseconds kClockTolerance{200};

}  // namespace

void FrameIntake::begin_stream(const CameraSettings& in_force) {
  slices_.reset();
  if (needs_unpacking(in_force.pixel_format, in_force.significant_bits)) {
    const auto pixels = static_cast<std::size_t>(in_force.width) * static_cast<std::size_t>(in_force.height);
    slices_ = std::make_unique<SlicePool>(in_force.pool_frames,
                                          pixels * static_cast<std::size_t>(bytes_per_pixel(in_force.slice_format())));
  }
  counter_.restart();
}

std::optional<Frame> FrameIntake::take(FrameBuffers& buffers, ArvBuffer* buffer, const CameraSettings& in_force,
                                       HostTime configured) {
  Frame frame;
  frame.lease = buffers.lease(buffer);
  std::string refusal;
  frame.status = check_frame(buffer, in_force, refusal);
  if (frame.status == FrameStatus::kIncomplete) {
    // Everything but the status may be left over from the slot's last use.
    ++frames_failed_;
    ++failed_since_good_;
    return frame;
  }
  count_id(arv_buffer_get_frame_id(buffer), frame);
  if (frame.status != FrameStatus::kOk) {
    refusal_ = std::move(refusal);
    ++frames_failed_;
    return frame;
  }
  frame.exposure_start = clock_.to_host(arv_buffer_get_timestamp(buffer)).value_or(HostTime::min());
  frame.exposure_end = frame.exposure_start + std::chrono::duration_cast<HostClock::duration>(
                                                  std::chrono::duration<double, std::micro>(in_force.exposure_us));
  if (frame.exposure_start < configured - kClockTolerance) return std::nullopt;
  if (misdated(frame)) return frame;
  const std::span<const std::byte> image = wire_image(buffer, in_force);
  const std::byte* pixels = image.data();
  if (slices_) {
    if (!unpack_into_slice(in_force, image, frame)) return frame;
    pixels = slices_->bytes(frame.lease).data();
  }
  ++frames_complete_;
  frame.image = {in_force.slice_format(), in_force.width, in_force.height,
                 static_cast<std::ptrdiff_t>(in_force.width) * bytes_per_pixel(in_force.slice_format()), pixels};
  return frame;
}

/// A frame that has arrived was exposed before. A camera may date it by the end of its exposure; what lies further
/// ahead is no time of this clock any more.
bool FrameIntake::misdated(Frame& frame) {
  const HostTime now = HostClock::now();
  const auto ahead = frame.exposure_end - now;
  if (ahead <= frame.exposure_end - frame.exposure_start + kClockTolerance) return false;
  frame.status = FrameStatus::kMisdated;
  ++frames_failed_;
  clock_.doubt();
  const bool first = refusal_.empty();
  refusal_ = "a frame came whose exposure is to end " +
             std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(ahead).count()) +
             " ms later: the camera's clock was set (PTP) or wrapped; it is measured anew";
  if (first) spdlog::warn("camera: {}", refusal_);
  return true;
}

void FrameIntake::count_id(std::uint64_t block_id, Frame& frame) {
  const std::uint64_t last = counter_.last();
  frame.id = counter_.unwrap(block_id);
  if (frame.id > last + 1) ids_skipped_ += frame.id - last - 1 - std::min(frame.id - last - 1, failed_since_good_);
  failed_since_good_ = 0;
}

/// False, and the frame is incomplete, if all slices are lent. Else the frame holds a slice and the buffer is back.
bool FrameIntake::unpack_into_slice(const CameraSettings& in_force, std::span<const std::byte> image, Frame& frame) {
  FrameLease slot = slices_->borrow();
  if (!slot) {
    ++slice_underruns_;
    ++frames_failed_;
    frame.status = FrameStatus::kIncomplete;
    return false;
  }
  unpack({in_force.pixel_format, in_force.significant_bits, in_force.bayer, in_force.width, in_force.height, image},
         slices_->bytes(slot));
  frame.lease = std::move(slot);
  return true;
}

std::uint64_t FrameIntake::discard(FrameBuffers& buffers, ArvBuffer* buffer, const CameraSettings& in_force) {
  const FrameLease lease = buffers.lease(buffer);
  std::string refusal;
  if (check_frame(buffer, in_force, refusal) != FrameStatus::kOk) return 0;
  (void)counter_.unwrap(arv_buffer_get_frame_id(buffer));
  return arv_buffer_get_timestamp(buffer);
}

void FrameIntake::count_into(CameraHealth& health) const {
  health.frames_complete += frames_complete_;
  health.frames_failed += frames_failed_;
  health.ids_skipped += ids_skipped_;
  health.underruns += slice_underruns_;
}

}  // namespace fvd
