#include "drivers/gige/found_camera.hpp"

#include <cctype>

namespace fvd {

namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string without_separators(const std::string& mac) {
  std::string digits;
  for (const char c : mac) {
    if (c != ':' && c != '-') digits += c;
  }
  return digits;
}

}  // namespace

bool same_name(const std::string& a, const std::string& b) { return !a.empty() && lower(a) == lower(b); }

std::string FoundCamera::text() const {
  if (link == CameraLink::kUsb) return id() + " (USB)";
  return id() + " at " + address + ", MAC " + mac + (user_name.empty() ? "" : ", named " + user_name);
}

bool FoundCamera::is_called(const std::string& name) const {
  return same_name(address, name) || same_name(serial, name) || same_name(user_name, name) || same_name(id(), name) ||
         same_name(without_separators(mac), without_separators(name));
}

}  // namespace fvd
