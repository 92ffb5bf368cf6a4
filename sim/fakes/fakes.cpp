#include "sim/fakes/fakes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <utility>

#include "core/base/error.hpp"

namespace fvd::sim {

using std::chrono::milliseconds;

void FakeClock::wait_until(HostTime deadline, std::stop_token stop) {
  if (!stop.stop_requested()) advance_to(deadline);
}

void FakeClock::advance_to(HostTime time) { now_ = std::max(now_, time); }

FakeCamera::FakeCamera(FakeClock& clock, int width, int height, std::deque<TriggerOutcome> script)
    : clock_(clock), width_(width), height_(height), script_(std::move(script)) {}

FakeCamera::~FakeCamera() {
  if (script_.empty() || std::uncaught_exceptions() > 0) return;
  std::fprintf(stderr, "FakeCamera: %zu step(s) of its script were never triggered\n", script_.size());
  std::abort();
}

CameraInfo FakeCamera::info() const { return {"fake", "camera", "1", "", "in process", width_, height_, true}; }

CameraSettings FakeCamera::configure(const CameraSettings& settings) {
  interrupted_ = false;
  CameraSettings effective = settings;
  effective.width = width_;
  effective.height = height_;
  return effective;
}

void FakeCamera::arrive(milliseconds after, FrameStatus status, std::uint64_t id, HostTime exposure_start) {
  pending_.push_back({clock_.now() + after, status, id, exposure_start, static_cast<std::uint8_t>(triggers_ % 256)});
}

void FakeCamera::trigger() {
  auto outcome = TriggerOutcome::kFrame;
  if (!script_.empty()) {
    outcome = script_.front();
    script_.pop_front();
  }
  ++triggers_;
  const HostTime now = clock_.now();
  const std::uint64_t id = next_id_++;
  switch (outcome) {
    case TriggerOutcome::kFrame:
      return arrive(milliseconds(10), FrameStatus::kOk, id, now);
    case TriggerOutcome::kNothing:
      return;
    case TriggerOutcome::kIncomplete:
      return arrive(milliseconds(10), FrameStatus::kIncomplete, id, now);
    case TriggerOutcome::kWrongGeometry:
      return arrive(milliseconds(10), FrameStatus::kWrongGeometry, id, now);
    case TriggerOutcome::kLate:
      return arrive(milliseconds(105), FrameStatus::kOk, id, now);
    case TriggerOutcome::kTwice:
      arrive(milliseconds(10), FrameStatus::kOk, id, now);
      return arrive(milliseconds(11), FrameStatus::kOk, id, now);
    case TriggerOutcome::kUnderrun:
      ++health_.underruns;
      return;
    case TriggerOutcome::kTooEarly:
      return arrive(milliseconds(10), FrameStatus::kOk, id, now - milliseconds(200));
    case TriggerOutcome::kDisconnect:
      connected_ = false;
      throw Error(ErrorCode::kCameraDisconnected, "the fake camera was unplugged");
  }
}

std::optional<Frame> FakeCamera::next_frame(HostTime deadline) {
  if (interrupted_.exchange(false)) return std::nullopt;
  const auto first = std::min_element(pending_.begin(), pending_.end(),
                                      [](const Pending& a, const Pending& b) { return a.arrival < b.arrival; });
  if (first == pending_.end() || first->arrival > std::max(deadline, clock_.now())) {
    clock_.advance_to(deadline);
    return std::nullopt;
  }
  clock_.advance_to(first->arrival);
  const Pending pending = *first;
  pending_.erase(first);
  return lend(pending);
}

Frame FakeCamera::lend(const Pending& pending) {
  const auto bytes = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  auto pixels = std::make_unique<std::byte[]>(bytes);
  std::memset(pixels.get(), pending.content, bytes);
  if (paint) paint(pending.content, {pixels.get(), bytes});
  Frame frame;
  frame.status = pending.status;
  frame.image = {PixelFormat::kMono8, width_, height_, width_, pixels.get()};
  frame.id = pending.id;
  frame.exposure_start = pending.exposure_start + clock_error;
  frame.exposure_end = frame.exposure_start + milliseconds(5);
  frame.lease = FrameLease(pixels.release(), FrameSlotDeleter{this});
  ++lent_;
  return frame;
}

void FakeCamera::recycle(void* slot) noexcept {
  --lent_;
  std::unique_ptr<std::byte[]>(static_cast<std::byte*>(slot));
}

StageStatus FakeAxis::status() {
  StageStatus status;
  status.enabled = true;
  status.homed = is_homed;
  status.in_position = true;
  status.position = Micrometers{position_um_};
  return status;
}

void FakeAxis::home(std::stop_token /*stop*/) {
  is_homed = true;
  position_um_ = 0.0;
}

MoveRecord FakeAxis::move_to(Micrometers target, const SettleCriterion& /*criterion*/, std::stop_token stop) {
  if (on_move) on_move();
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the fake axis was stopped");
  if (fail_at_um == target.value) throw Error(ErrorCode::kStagePosition, "the fake axis does not settle");
  targets_um.push_back(target.value);
  position_um_ = target.value + error_um;
  MoveRecord move;
  move.target = target;
  move.target_quantised = target;
  move.position = Micrometers{position_um_};
  move.started = clock_.now();
  clock_.advance_to(clock_.now() + milliseconds(50));
  move.settled = settled = clock_.now();
  move.halted = move.settled;
  move.polls = 3;
  return move;
}

MoveRecord FakeAxis::sweep_to(Micrometers target, double /*speed_um_per_s*/, std::stop_token stop) {
  return move_to(target, {}, stop);
}

PositionMean FakeAxis::position_at(HostTime /*at*/, std::chrono::microseconds /*reach*/) {
  return {Micrometers{position_um_}, Micrometers{0.0}, 3};
}

PositionMean FakeAxis::mean_position(HostTime from, HostTime /*to*/) {
  mean_moved = mean_moved || from < settled;
  return {Micrometers{position_um_}, Micrometers{0.0}, 3};
}

bool SpySink::push(Slice&& slice, HostTime /*deadline*/, std::stop_token /*stop*/) {
  if (static_cast<int>(z_um.size()) == refuse_at) return false;
  z_um.push_back(slice.z_um);
  contents.push_back(slice.frame.image.as<std::uint8_t>().at(0, 0));
  const Slice taken = std::move(slice);
  return true;
}

}  // namespace fvd::sim
