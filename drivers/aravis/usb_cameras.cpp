#include "drivers/aravis/usb_cameras.hpp"

#include <arv.h>

namespace fvd {

std::vector<FoundCamera> list_usb_cameras() {
  std::vector<FoundCamera> cameras;
  ArvInterface* const usb = arv_uv_interface_get_instance();  // Aravis keeps it
  arv_interface_update_device_list(usb);
  const auto text = [](const char* value) { return std::string(value == nullptr ? "" : value); };
  for (unsigned i = 0; i < arv_interface_get_n_devices(usb); ++i) {
    FoundCamera camera;
    camera.link = CameraLink::kUsb;
    camera.vendor = text(arv_interface_get_device_vendor(usb, i));
    camera.model = text(arv_interface_get_device_model(usb, i));
    camera.serial = text(arv_interface_get_device_serial_nbr(usb, i));
    camera.address = text(arv_interface_get_device_id(usb, i));
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace fvd
