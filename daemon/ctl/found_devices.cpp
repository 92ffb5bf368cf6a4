#include "daemon/ctl/found_devices.hpp"

#include <sstream>
#include <variant>

namespace fvd::ctl {

namespace {

using Json = nlohmann::ordered_json;

const char* control_name(CameraControl control) {
  switch (control) {
    case CameraControl::kFree:
      return "free";
    case CameraControl::kControlled:
      return "controlled";
    case CameraControl::kUnknown:
      break;
  }
  return "unknown";
}

Json to_json(const FoundCamera& camera) {
  Json json{{"link", camera.link == CameraLink::kUsb ? "usb" : "gige"},
            {"vendor", camera.vendor},
            {"model", camera.model},
            {"serial", camera.serial},
            {"user_name", camera.user_name},
            {"address", camera.address},
            {"control", control_name(camera.control)}};
  if (camera.link == CameraLink::kUsb) {
    json["node"] = camera.node;
    json["accessible"] = camera.accessible;
    return json;
  }
  json["firmware"] = camera.firmware;
  json["mac"] = camera.mac;
  json["mask"] = camera.mask;
  json["gateway"] = camera.gateway;
  json["persistent_address"] = (camera.ip_configuration & 1U) != 0;
  json["dhcp"] = (camera.ip_configuration & 2U) != 0;
  json["interface"] = camera.interface;
  json["interface_address"] = camera.interface_address;
  json["subnet_fits"] = camera.subnet_fits;
  json["controller"] = camera.controller.empty() ? Json() : Json(camera.controller);
  return json;
}

}  // namespace

std::string line_text(const ModbusLinkConfig& config) {
  if (const auto* tcp = std::get_if<ModbusTcpEndpoint>(&config.endpoint)) {
    return tcp->host + ":" + std::to_string(tcp->port);
  }
  const auto& line = std::get<ModbusSerialEndpoint>(config.endpoint);
  return line.device + " " + std::to_string(line.baud) + " 8" + line.parity + std::to_string(line.stop_bits);
}

std::string camera_text(const FoundCamera& camera) {
  std::ostringstream text;
  text << camera.vendor << " " << camera.model << ", serial " << camera.serial;
  if (camera.link == CameraLink::kUsb) {
    text << ", USB, address " << camera.address;
    if (!camera.accessible) text << ", no permission to open " << camera.node << ": see the udev rule";
    return text.str();
  }
  text << ", MAC " << camera.mac << ", at " << camera.address;
  if (!camera.interface.empty()) text << " through " << camera.interface;
  if (!camera.user_name.empty()) text << ", called '" << camera.user_name << "'";
  if (camera.control == CameraControl::kFree) text << ", nobody controls it";
  if (camera.control == CameraControl::kControlled) {
    text << ", controlled by " << (camera.controller.empty() ? "another program" : camera.controller);
  }
  if (!camera.subnet_fits) {
    text << ", in another subnet (" << camera.mask << ") than " << camera.interface_address
         << ": it cannot be opened; fvdctl camera set-ip gives it an address that fits";
  }
  return text.str();
}

std::string to_text(const FoundDevices& found) {
  std::ostringstream text;
  text << "cameras\n";
  for (const FoundCamera& camera : found.cameras) text << "  " << camera_text(camera) << "\n";
  if (found.cameras.empty()) text << "  none answers\n";
  for (const std::string& problem : found.problems) text << "  " << problem << "\n";
  if (!found.serial_ports.empty()) text << "serial ports\n";
  for (const std::string& port : found.serial_ports) text << "  " << port << "\n";
  for (const FoundLine& line : found.lines) {
    text << "units at " << line.line << "\n";
    for (const FoundUnit& unit : line.units) text << "  unit " << unit.unit << ": " << unit.answer << "\n";
    if (!line.problem.empty()) {
      text << "  " << line.problem << "\n";
    } else if (line.units.empty()) {
      text << "  none answers\n";
    }
  }
  return text.str();
}

Json to_json(const FoundDevices& found) {
  Json json{{"cameras", Json::array()}, {"problems", found.problems}, {"serial_ports", found.serial_ports}};
  for (const FoundCamera& camera : found.cameras) json["cameras"].push_back(to_json(camera));
  json["lines"] = Json::array();
  for (const FoundLine& line : found.lines) {
    Json units = Json::array();
    for (const FoundUnit& unit : line.units) units.push_back({{"unit", unit.unit}, {"answer", unit.answer}});
    json["lines"].push_back({{"line", line.line},
                             {"units", std::move(units)},
                             {"problem", line.problem.empty() ? Json() : Json(line.problem)}});
  }
  return json;
}

}  // namespace fvd::ctl
