#include "drivers/aravis/busy_commands.hpp"

#include <atomic>
#include <mutex>

#include <arv.h>

namespace fvd {

namespace {

std::atomic<std::uint64_t> busy_count{0};

/// The functions of Aravis' class, as they were.
ArvDeviceClass& original() {
  static ArvDeviceClass functions{};
  return functions;
}

template <typename Access>
gboolean patiently(GError** error, Access access) {
  gboolean done = FALSE;
  GError* failure = nullptr;
  (void)while_busy([&] {
    g_clear_error(&failure);
    done = access(&failure);
    const bool busy = g_error_matches(failure, ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY) != FALSE;
    if (busy) ++busy_count;
    return busy;
  });
  if (failure != nullptr) g_propagate_error(error, failure);
  return done;
}

gboolean read_memory(ArvDevice* device, guint64 address, guint32 size, void* buffer, GError** error) {
  return patiently(error, [&](GError** out) { return original().read_memory(device, address, size, buffer, out); });
}

gboolean write_memory(ArvDevice* device, guint64 address, guint32 size, void* buffer, GError** error) {
  return patiently(error, [&](GError** out) { return original().write_memory(device, address, size, buffer, out); });
}

gboolean read_register(ArvDevice* device, guint64 address, guint32* value, GError** error) {
  return patiently(error, [&](GError** out) { return original().read_register(device, address, value, out); });
}

gboolean write_register(ArvDevice* device, guint64 address, guint32 value, GError** error) {
  return patiently(error, [&](GError** out) { return original().write_register(device, address, value, out); });
}

}  // namespace

/// Every feature access of Aravis goes through these four functions of the device's class.
void repeat_busy_commands() {
  static std::once_flag once;
  std::call_once(once, [] {
    auto* functions = static_cast<ArvDeviceClass*>(g_type_class_ref(ARV_TYPE_GV_DEVICE));  // never given back
    original() = *functions;
    functions->read_memory = &read_memory;
    functions->write_memory = &write_memory;
    functions->read_register = &read_register;
    functions->write_register = &write_register;
  });
}

std::uint64_t busy_answers() noexcept { return busy_count; }

}  // namespace fvd
