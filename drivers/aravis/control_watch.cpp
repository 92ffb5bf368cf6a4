#include "drivers/aravis/control_watch.hpp"

#include <chrono>
#include <thread>

#include <spdlog/spdlog.h>

#include "core/base/clock.hpp"

namespace fvd {

namespace {

/// An emission takes microseconds; this is for a machine that is very busy.
constexpr std::chrono::seconds kEmissionTimeout{5};

}  // namespace

void ControlWatch::watch(ArvDevice* device) {
  device_.reset(static_cast<ArvDevice*>(g_object_ref(device)));
  // The handler owns a share of the flag: it may run in the heartbeat's thread while this object goes.
  handler_ = g_signal_connect_data(
      device, "control-lost", G_CALLBACK(&ControlWatch::on_control_lost), new Flag(lost_),
      [](gpointer flag, GClosure*) { delete static_cast<Flag*>(flag); }, GConnectFlags{});
}

void ControlWatch::on_control_lost(ArvDevice* /*device*/, gpointer flag) { **static_cast<Flag*>(flag) = true; }

ControlWatch::~ControlWatch() {
  if (!device_) return;
  // Without a handler no new emission begins; one that runs ends soon.
  g_signal_handler_disconnect(device_.get(), handler_);
  const HostTime deadline = HostClock::now() + kEmissionTimeout;
  while (g_atomic_int_get(&G_OBJECT(device_.get())->ref_count) > 1) {
    if (HostClock::now() > deadline) {
      spdlog::error("a camera that was closed is still in use; its memory is not given back");
      static_cast<void>(device_.release());
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace fvd
