#include "daemon/ctl/device_commands.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/found_devices.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/rpc_endpoint.hpp"
#include "daemon/ctl/stop_on_signal.hpp"
#include "drivers/aravis/usb_cameras.hpp"
#include "drivers/gige/gvcp_socket.hpp"
#include "drivers/gige/set_ip.hpp"
#include "drivers/modbus/modbus_axis.hpp"

namespace fvd::ctl {

namespace {

using Json = nlohmann::ordered_json;

std::uint32_t address_of(const std::string& text, const char* what) {
  const auto address = gvcp::address_of(text);
  if (!address) throw UsageError(std::string(what) + ": '" + text + "' is no IPv4 address such as 192.168.10.20");
  return *address;
}

std::vector<NetworkInterface> interfaces_of(const DevicesArguments& arguments) {
  if (arguments.interfaces.empty()) return network_interfaces();
  std::vector<NetworkInterface> interfaces;
  for (const std::string& name : arguments.interfaces) {
    for (NetworkInterface& one : network_interfaces(name)) {
      const bool known = std::any_of(interfaces.begin(), interfaces.end(), [&](const NetworkInterface& other) {
        return other.index == one.index && other.address == one.address;  // named twice: by name and by address
      });
      if (!known) interfaces.push_back(std::move(one));
    }
  }
  return interfaces;
}

/// Cameras on the networks, and at the addresses that were named. Where nothing can be asked is a problem of its own.
void find_network_cameras(const DevicesArguments& arguments, FoundDevices& found) {
  const auto search = [&found](const auto& cameras) {
    try {
      for (FoundCamera& camera : cameras()) found.cameras.push_back(std::move(camera));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kCameraDisconnected) throw;
      found.problems.emplace_back(error.what());
    }
  };
  if (arguments.at.empty() || !arguments.interfaces.empty()) {
    search([&] { return discover_cameras(interfaces_of(arguments)); });
  }
  for (const std::string& at : arguments.at) {
    search([address = address_of(at, "--at")] {
      auto camera = discover_camera_at(address);
      return camera ? std::vector{std::move(*camera)} : std::vector<FoundCamera>{};
    });
  }
}

std::pair<int, int> units_of(const std::string& text) {
  const auto dash = text.find('-');
  const std::string first = text.substr(0, dash);
  const std::string last = dash == std::string::npos ? first : text.substr(dash + 1);
  const auto number = [&text](const std::string& digits) {
    int value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc() && end == digits.data() + digits.size() && value >= 1 && value <= 247) return value;
    throw UsageError("--units " + text + ": expected a unit of 1..247, or a range of them such as 1-10");
  };
  const std::pair range(number(first), number(last));
  if (range.first > range.second) throw UsageError("--units " + text + ": the range begins above its end");
  return range;
}

/// One scan for each line that was named.
std::vector<UnitScan> scans_of(const DevicesArguments& arguments) {
  if (arguments.units.empty()) {
    if (arguments.tcp.empty() && arguments.serial.empty()) return {};
    throw UsageError("--units is missing: which units are to be asked, e.g. --units 1-10");
  }
  const auto [first, last] = units_of(arguments.units);
  std::vector<UnitScan> scans;
  StageConfig stage = arguments.line;
  stage.response_timeout = std::chrono::milliseconds(arguments.response_timeout_ms);
  for (const std::string& where : arguments.tcp) {
    const bool has_port = where.rfind(':') != std::string::npos;
    const RpcEndpoint endpoint = parse_endpoint(has_port ? where : where + ":502");
    stage.transport = "tcp";
    stage.address = endpoint.host;
    stage.port = endpoint.port;
    scans.push_back({modbus_link_config(stage), first, last});
  }
  for (const std::string& port : arguments.serial) {
    stage.transport = "rtu";
    stage.serial_device = port;
    scans.push_back({modbus_link_config(stage), first, last});
  }
  return scans;
}

int run_devices(const DevicesArguments& arguments, const Terminal& terminal) {
  const std::vector<UnitScan> scans = scans_of(arguments);
  const StopOnSignal signal;
  FoundDevices found;
  find_network_cameras(arguments, found);
  for (FoundCamera& camera : list_usb_cameras().value_or(std::vector<FoundCamera>{})) {
    found.cameras.push_back(std::move(camera));
  }
  if (!arguments.units.empty()) found.serial_ports = serial_ports();
  for (const UnitScan& scan : scans) {
    FoundLine line{line_text(scan.line), {}, {}};
    const auto progress = [&](int unit) {
      if (terminal.err_is_terminal) terminal.err << "\r" << line.line << " unit " << unit << "   " << std::flush;
    };
    try {
      line.units = scan_units(scan, progress, signal.token());
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kStageDisconnected) throw;
      line.problem = error.what();
    }
    if (terminal.err_is_terminal) terminal.err << "\n";
    found.lines.push_back(std::move(line));
  }
  if (arguments.json) {
    terminal.out << to_json(found).dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
  } else {
    terminal.out << to_text(found) << std::flush;
  }
  const bool failed =
      !found.problems.empty() ||
      std::any_of(found.lines.begin(), found.lines.end(), [](const FoundLine& line) { return !line.problem.empty(); });
  return failed ? kExitUnavailable : kExitOk;
}

FoundCamera camera_named(const std::string& name, const std::vector<FoundCamera>& cameras) {
  std::vector<FoundCamera> fitting;
  std::string seen;
  for (const FoundCamera& camera : cameras) {
    // One that answers through several interfaces is one camera.
    const bool known = std::any_of(fitting.begin(), fitting.end(), [&](const FoundCamera& other) {
      return other.mac == camera.mac && other.address == camera.address;
    });
    if (camera.is_called(name) && !known) fitting.push_back(camera);
    seen += "; " + camera_text(camera);
  }
  if (fitting.size() == 1) return fitting.front();
  const std::string what = fitting.empty() ? "no camera" : "more than one camera";
  throw Error(ErrorCode::kCameraDisconnected,
              what + " is called '" + name + "' by its serial number, MAC, name or address; " +
                  (seen.empty() ? "none answers: is it powered, and on the wire of --interface?" : "found" + seen));
}

NetworkInterface interface_of(const FoundCamera& camera, const std::vector<NetworkInterface>& interfaces) {
  for (const NetworkInterface& one : interfaces) {
    if (one.name == camera.interface && gvcp::address_text(one.address) == camera.interface_address) return one;
  }
  throw Error(ErrorCode::kInternal, "the interface " + camera.interface + " is gone");
}

int run_set_ip(const DevicesArguments& arguments, const Terminal& terminal) {
  CameraAddress wanted;
  wanted.address = address_of(arguments.address, "--address");
  wanted.gateway = address_of(arguments.gateway, "--gateway");
  const std::vector<NetworkInterface> interfaces = interfaces_of(arguments);
  const FoundCamera camera = camera_named(arguments.camera, discover_cameras(interfaces));
  const NetworkInterface interface = interface_of(camera, interfaces);
  wanted.mask = arguments.mask.empty() ? interface.mask : address_of(arguments.mask, "--mask");
  check_address(wanted, interface);
  const bool is_there = camera.address == gvcp::address_text(wanted.address) && camera.subnet_fits;
  if (!is_there || !arguments.persistent) force_ip(camera, wanted, interface);
  if (arguments.persistent) set_persistent_ip(wanted.address, wanted);
  const std::string lasts =
      arguments.persistent ? "for good" : "until it is switched off; --persistent sets it for good";
  if (arguments.json) {
    terminal.out << Json{{"serial", camera.serial},
                         {"mac", camera.mac},
                         {"address", arguments.address},
                         {"mask", gvcp::address_text(wanted.mask)},
                         {"persistent", arguments.persistent}}
                        .dump(2, ' ', false, Json::error_handler_t::replace)
                 << std::endl;
  } else {
    terminal.out << "camera " << camera.serial << " (" << camera.mac << ") has the address " << arguments.address << " "
                 << lasts << std::endl;
  }
  return kExitOk;
}

void add_devices(CLI::App& app, DevicesArguments& a, const Terminal& terminal, std::function<int()>& chosen) {
  CLI::App* sub = app.add_subcommand(
      "devices", "list cameras and, asked with a range of units, drives that answer; reads only, nothing moves");
  sub->add_option("--interface", a.interfaces, "look for cameras through this network interface or address only")
      ->allow_extra_args(false);
  sub->add_option("--at", a.at, "ask for a camera at this address, e.g. behind a router; others only with --interface")
      ->allow_extra_args(false);
  sub->add_option("--units", a.units, "look for Modbus units too: N or N-M; lists the serial ports");
  sub->add_option("--tcp", a.tcp, "HOST or HOST:PORT whose units are asked")->allow_extra_args(false);
  sub->add_option("--serial", a.serial, "serial port whose units are asked: whatever is on it gets bytes sent")
      ->allow_extra_args(false);
  sub->add_option("--baud", a.line.serial_baud, "bit rate of the serial ports")->capture_default_str();
  sub->add_option("--parity", a.line.serial_parity, "parity of the serial ports")
      ->check(CLI::IsMember({"none", "even", "odd"}))
      ->capture_default_str();
  sub->add_option("--stop-bits", a.line.serial_stop_bits, "stop bits of the serial ports")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  sub->add_option("--response-timeout-ms", a.response_timeout_ms, "longest wait for a unit's answer")
      ->check(CLI::Range(10, 10000))
      ->capture_default_str();
  sub->add_flag("--json", a.json, "print JSON");
  sub->callback([&] { chosen = [&] { return run_devices(a, terminal); }; });
}

}  // namespace

void add_device_commands(CLI::App& app, DevicesArguments& a, const Terminal& terminal, std::function<int()>& chosen) {
  add_devices(app, a, terminal, chosen);
  CLI::App* camera = app.add_subcommand("camera", "set up a camera, without the daemon");
  camera->require_subcommand(1);
  CLI::App* sub = camera->add_subcommand(
      "set-ip", "give a camera another IP address, also one whose subnet does not fit; nobody may control it");
  sub->add_option("camera", a.camera, "its serial number, MAC, user-defined name or address, as `devices` prints them")
      ->required();
  sub->add_option("--address", a.address, "its new address")->required();
  sub->add_option("--mask", a.mask, "its subnet; default: that of the interface");
  sub->add_option("--gateway", a.gateway, "its gateway; 0.0.0.0 = none")->capture_default_str();
  sub->add_flag("--persistent", a.persistent, "for good; without it until the camera is switched off");
  sub->add_option("--interface", a.interfaces, "look for it through this network interface or address only")
      ->allow_extra_args(false);
  sub->add_flag("--json", a.json, "print JSON");
  sub->callback([&] { chosen = [&] { return run_set_ip(a, terminal); }; });
}

}  // namespace fvd::ctl
