#include "drivers/aravis/camera_presence.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "drivers/aravis/busy_commands.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

/// Longest wait for the first answer of a camera that is to be opened. GigE Vision lets it take 200 ms.
constexpr std::chrono::milliseconds kFirstAnswer{400};
/// Longest time between two looks at an open request.
constexpr std::chrono::milliseconds kLongestGap{900};
/// Longest wait of look_after() for one answer.
constexpr std::chrono::milliseconds kLook{100};

/// The cameras that objects of this process control, also those that the reaper is closing.
class ControlledCameras {
 public:
  void add(const std::string& ip) {
    const MutexLock lock(mutex_);
    cameras_.insert(ip);
  }
  void remove(const std::string& ip) {
    const MutexLock lock(mutex_);
    if (const auto found = cameras_.find(ip); found != cameras_.end()) cameras_.erase(found);
  }
  [[nodiscard]] bool contains(const std::string& ip) {
    const MutexLock lock(mutex_);
    return cameras_.contains(ip);
  }

 private:
  Mutex mutex_;
  std::multiset<std::string> cameras_ FVD_GUARDED_BY(mutex_);
};

ControlledCameras& controlled() {
  static ControlledCameras cameras;
  return cameras;
}

std::string ip_of(ArvDevice* device) {
  GSocketAddress* address = arv_gv_device_get_device_address(ARV_GV_DEVICE(device));
  const std::unique_ptr<char, decltype(&g_free)> ip(
      g_inet_address_to_string(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(address))), &g_free);
  return ip.get();
}

}  // namespace

CameraPresence::~CameraPresence() {
  if (!held_.empty()) controlled().remove(held_);
}

void CameraPresence::require_free(const std::string& ip) const {
  GvcpProbe probe(ip);
  switch (probe.ask(kFirstAnswer)) {
    case GvcpProbe::Answer::kFree:
    case GvcpProbe::Answer::kTellsNothing:
      return;
    case GvcpProbe::Answer::kControlled:
      // What the register says may be out of date; what the camera does with a request for control counts.
      if (probe.control_denied(kFirstAnswer)) throw_controlled(ip);
      return;
    case GvcpProbe::Answer::kNone:
    case GvcpProbe::Answer::kAbsent:
      throw Error(ErrorCode::kCameraDisconnected,
                  "no camera answers at " + name_ + "; is it powered, in this network, and its address right?");
  }
}

void CameraPresence::watch(ArvDevice* device) {
  control_.watch(device);
  if (ARV_IS_GV_DEVICE(device) == FALSE) return;
  const std::string ip = ip_of(device);
  take_control(ip);
  controlled().add(ip);
  held_ = ip;
  open_probe(ip);
}

/// Aravis has tried once and tells the outcome only; a camera that was busy just then is asked again.
void CameraPresence::take_control(const std::string& ip) const {
  auto* device = ARV_GV_DEVICE(control_.device());
  if (arv_gv_device_is_controller(device) != FALSE) return;
  GErrorSlot error;
  (void)while_busy([&] {
    arv_gv_device_take_control(device, error.out());
    return error.is_busy();
  });
  if (!error.failed()) return;
  if (error.is_access_denied()) throw_controlled(ip);
  error.check("the camera at " + name_ + " gives no control", ErrorCode::kCameraDisconnected);
}

void CameraPresence::throw_controlled(const std::string& ip) const {
  throw Error(ErrorCode::kCameraDisconnected,
              controlled().contains(ip)
                  ? "the camera at " + name_ + " is still held by the connection that was given up; it is opened again"
                  : "the camera at " + name_ +
                        " denies access: it is controlled by another program, or by one that died less than its "
                        "heartbeat timeout ago");
}

void CameraPresence::open_probe(const std::string& ip) {
  probe_.emplace(ip);
  const auto answer = probe_->ask(kFirstAnswer);
  if (answer == GvcpProbe::Answer::kControlled || answer == GvcpProbe::Answer::kTellsNothing) return;
  spdlog::warn("the camera at {} answers its controller only; its loss will be noticed late", name_);
  probe_.reset();
}

void CameraPresence::require_connected() const {
  if (!lost()) return;
  throw Error(ErrorCode::kCameraDisconnected,
              "the connection to the camera at " + name_ + " is lost: " + loss_ + "; it is being opened again");
}

void CameraPresence::lose(const char* why) {
  loss_ = why;
  set_lost();
  require_connected();
  throw Error(ErrorCode::kInternal, "a lost camera is connected");
}

bool CameraPresence::alive() {
  require_connected();
  if (!probe_) return false;
  // A request that nobody looked after was not repeated either: it proves nothing.
  const HostTime now = HostClock::now();
  if (!asked_ || now - looked_ > kLongestGap) {
    probe_->begin();
    asked_ = now;
  }
  looked_ = now;
  switch (probe_->look()) {
    case GvcpProbe::Answer::kControlled:
    case GvcpProbe::Answer::kTellsNothing:
      heard();
      return true;
    case GvcpProbe::Answer::kFree:
      lose("nobody controls it any more, as after a restart");
    case GvcpProbe::Answer::kAbsent:
      lose("its host says that nobody listens there");
    case GvcpProbe::Answer::kNone:
      break;
  }
  if (HostClock::now() >= std::max(*asked_ + silence_, probe_->pending_until())) {
    lose("it answers nothing; check power and cable");
  }
  return false;
}

void CameraPresence::look_after() {
  if (!probe_) return require_connected();
  const HostTime deadline = HostClock::now() + kLook;
  while (!alive() && HostClock::now() < deadline) probe_->wait(deadline);
}

}  // namespace fvd
