#include "drivers/modbus/unit_scan.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "core/base/error.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    paths.push_back(entry->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// A gateway answers in place of units that are not there.
bool is_of_gateway(const std::string& error) { return error == exception_text(0x0A) || error == exception_text(0x0B); }

}  // namespace

std::vector<std::string> serial_ports() {
  std::vector<std::string> ports;
  std::set<fs::path> named;
  std::error_code error;
  for (const fs::path& link : entries_of("/dev/serial/by-id")) {
    ports.push_back(link.string());
    named.insert(fs::canonical(link, error));
  }
  for (const fs::path& device : entries_of("/dev")) {
    const std::string name = device.filename().string();
    const bool serial = name.starts_with("ttyUSB") || name.starts_with("ttyACM") || name.starts_with("ttyAMA");
    if (serial && named.count(device) == 0) ports.push_back(device.string());
  }
  return ports;
}

std::vector<FoundUnit> scan_units(const UnitScan& scan, const std::function<void(int unit)>& on_unit,
                                  const std::stop_token& stop) {
  if (scan.first < 1 || scan.last > 247 || scan.first > scan.last) {
    throw Error(ErrorCode::kBadInput, "units " + std::to_string(scan.first) + "-" + std::to_string(scan.last) +
                                          ": expected a range within 1-247");
  }
  std::vector<FoundUnit> found;
  for (int unit = scan.first; unit <= scan.last; ++unit) {
    if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the search was asked to stop");
    if (on_unit) on_unit(unit);
    ModbusLinkConfig line = scan.line;
    line.unit = unit;
    ModbusTransport transport(line);
    std::string error;
    bool renewed = false;
    if (!transport.ensure_connected(false, renewed, error)) {
      throw Error(ErrorCode::kStageDisconnected, "cannot open " + transport.description() + ": " + error);
    }
    ModbusRequest request;
    request.read_count = 1;
    std::vector<std::uint16_t> values;
    auto answer = transport.transact(request, values, error);
    if (answer == PduAnswer::kLater && !is_of_gateway(error)) answer = transport.transact(request, values, error);
    if (answer == PduAnswer::kLater && is_of_gateway(error)) continue;
    if (answer == PduAnswer::kNone) {
      // The next unit must not be taken for this one, which may be late.
      transport.resynchronise([&stop] { return stop.stop_requested(); });
      continue;
    }
    const bool told = answer == PduAnswer::kOk && !values.empty();
    found.push_back({unit, told ? "register 0 is " + std::to_string(values.front()) : error});
  }
  return found;
}

}  // namespace fvd
