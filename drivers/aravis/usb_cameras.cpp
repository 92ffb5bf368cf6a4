/// USB3 Vision devices as the system lists them, whether this process may open them or not.

#include <fstream>

#include <unistd.h>

#include "drivers/aravis/camera_search.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

/// The first line of a file; empty if there is none.
std::string line_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

/// USB3 Vision 1.0: an interface of class "miscellaneous" and subclass "USB3 Vision".
bool is_usb3_vision(const fs::path& interface) {
  return line_of(interface / "bInterfaceClass") == "ef" && line_of(interface / "bInterfaceSubClass") == "05";
}

/// "2-1" of "2-1:1.0"
fs::path device_of(const fs::path& interface) {
  const std::string name = interface.filename().string();
  return interface.parent_path() / name.substr(0, name.find(':'));
}

std::string three_digits(const std::string& number) {
  return number.size() >= 3 ? number : std::string(3 - number.size(), '0') + number;
}

}  // namespace

std::optional<std::vector<UsbCamera>> list_usb_cameras(const fs::path& sysfs, const fs::path& dev) {
  std::error_code error;
  bool any = false;
  std::vector<UsbCamera> cameras;
  for (fs::directory_iterator entry(sysfs, error), end; !error && entry != end; entry.increment(error)) {
    any = true;
    const fs::path interface = entry->path();
    if (interface.filename().string().find(':') == std::string::npos || !is_usb3_vision(interface)) continue;
    const fs::path device = device_of(interface);
    UsbCamera camera{line_of(device / "manufacturer"), line_of(device / "product"), line_of(device / "serial"), {}};
    camera.node = (dev / three_digits(line_of(device / "busnum")) / three_digits(line_of(device / "devnum"))).string();
    camera.accessible = ::access(camera.node.c_str(), R_OK | W_OK) == 0;
    bool known = false;  // such a device has several interfaces
    for (const UsbCamera& one : cameras) known = known || one.node == camera.node;
    if (!known) cameras.push_back(std::move(camera));
  }
  if (!any) return std::nullopt;
  return cameras;
}

}  // namespace fvd
