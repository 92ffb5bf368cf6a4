#include "drivers/aravis/camera_presence.hpp"

#include <memory>

#include <arpa/inet.h>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

/// A camera that does not answer within this time is gone. GigE Vision lets it take 200 ms for an answer.
constexpr std::chrono::milliseconds kAnswerTimeout{200};

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

}  // namespace

void CameraPresence::require_free() const {
  if (address_.empty()) {
    throw Error(ErrorCode::kBadConfig,
                "the camera's address is empty: give its IP address or vendor-model-serial in /camera/address");
  }
  if (!is_ipv4(address_)) return;
  GvcpProbe probe(address_);
  switch (probe.ask(2 * kAnswerTimeout)) {
    case GvcpProbe::Answer::kFree:
      return;
    case GvcpProbe::Answer::kControlled:
      throw_controlled();
    case GvcpProbe::Answer::kNone:
    case GvcpProbe::Answer::kAbsent:
      throw Error(ErrorCode::kCameraDisconnected,
                  "no camera answers at " + address_ + "; is it powered, in this network, and its address right?");
  }
}

void CameraPresence::watch(ArvDevice* device) {
  control_.watch(device);
  if (ARV_IS_GV_DEVICE(device) == FALSE) return;
  require_control();
  open_probe();
}

void CameraPresence::require_control() const {
  if (arv_gv_device_is_controller(ARV_GV_DEVICE(control_.device())) == FALSE) throw_controlled();
}

void CameraPresence::throw_controlled() const {
  throw Error(ErrorCode::kCameraDisconnected,
              "the camera at " + address_ +
                  " is controlled by another program, or by one that died less than its heartbeat timeout ago");
}

void CameraPresence::open_probe() {
  GSocketAddress* address = arv_gv_device_get_device_address(ARV_GV_DEVICE(control_.device()));
  const std::unique_ptr<char, decltype(&g_free)> ip(
      g_inet_address_to_string(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(address))), &g_free);
  probe_.emplace(ip.get());
  if (probe_->ask(2 * kAnswerTimeout) == GvcpProbe::Answer::kControlled) return;
  spdlog::warn("the camera at {} answers its controller only; its loss will be noticed late", address_);
  probe_.reset();
}

void CameraPresence::require_connected() const {
  if (!lost()) return;
  throw Error(ErrorCode::kCameraDisconnected,
              "the connection to the camera at " + address_ + " is lost: " + loss_ + "; it is being opened again");
}

void CameraPresence::lose(const char* why) {
  loss_ = why;
  set_lost();
  require_connected();
  throw Error(ErrorCode::kInternal, "a lost camera is connected");
}

/// True if the answer says that the camera is alive and ours. Throws if it says that it is lost.
bool CameraPresence::judge(GvcpProbe::Answer answer) {
  switch (answer) {
    case GvcpProbe::Answer::kControlled:
      return true;
    case GvcpProbe::Answer::kFree:
      lose("nobody controls it any more, as after a restart");
    case GvcpProbe::Answer::kAbsent:
      lose("its host says that nobody listens there");
    case GvcpProbe::Answer::kNone:
      break;
  }
  return false;
}

void CameraPresence::require_life() {
  require_connected();
  if (probe_ && !judge(probe_->ask(kAnswerTimeout))) lose("it answers nothing; check power and cable");
}

bool CameraPresence::answers(Question& question) {
  if (!probe_) return false;
  if (!question.open) {
    probe_->begin();
    question = {true, HostClock::now()};
  }
  if (judge(probe_->look())) {
    question.open = false;
    return true;
  }
  if (HostClock::now() - question.asked >= kAnswerTimeout) lose("it answers nothing; check power and cable");
  return false;
}

}  // namespace fvd
