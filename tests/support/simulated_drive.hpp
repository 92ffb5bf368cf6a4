#pragma once

/// A simulated drive of any kind on either line, and the stage that drives it by the shipped profile.

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <ostream>
#include <string>

#include "drivers/modbus/modbus_axis.hpp"
#include "sim/axis/axis_model.hpp"
#include "sim/drives/drive_kinds.hpp"
#include "tests/support/simulated_line.hpp"

namespace fvd::test {

/// A drive and the profile that ships for it.
struct DriveCase {
  sim::DriveKind kind;
  const char* profile;
  const char* name;
};
inline constexpr DriveCase kDriveCases[] = {{sim::DriveKind::kAz, "oriental-az.json", "Az"},
                                            {sim::DriveKind::kAr, "oriental-ar.json", "Ar"},
                                            {sim::DriveKind::kLeadshine, "leadshine-pr.json", "Leadshine"},
                                            {sim::DriveKind::kScl, "applied-motion-scl.json", "Scl"},
                                            {sim::DriveKind::kCia402, "nanotec-cia402.json", "Cia402"}};
inline constexpr DriveCase kCia402 = kDriveCases[4];
inline constexpr int kCia402Controlword = 6000;

/// Standstill as most of the tests ask for it.
inline constexpr SettleCriterion kCriterion{.window = Micrometers{0.5},
                                            .samples = 3,
                                            .dwell = std::chrono::milliseconds(10),
                                            .timeout = std::chrono::milliseconds(5000)};

inline std::ostream& operator<<(std::ostream& out, const DriveCase& drive) { return out << drive.name; }

/// Where a drive takes the target of its next move, two words with the high one first.
inline int target_address(sim::DriveKind kind) {
  switch (kind) {
    case sim::DriveKind::kAz:
      return 0x005C;
    case sim::DriveKind::kAr:
      return 0x0400;
    case sim::DriveKind::kLeadshine:
      return 0x6201;
    case sim::DriveKind::kScl:
      return 30;
    case sim::DriveKind::kCia402:
      return 6002;
  }
  return 0;
}

/// A nearly perfect axis, so that errors in the figures are errors of fvd.
inline sim::AxisParameters good_axis() {
  sim::AxisParameters parameters;
  parameters.settle_noise_um = 0.02;
  parameters.encoder_noise_um = 0.01;
  parameters.start_latency_ms = 3.0;
  return parameters;
}

/// 115200 baud, a drive with a turnaround of 4 ms, an adapter with a latency timer of 1 ms.
inline sim::LineTiming real_line() {
  sim::LineTiming timing;
  timing.turnaround = std::chrono::milliseconds(4);
  timing.usb_latency = std::chrono::milliseconds(1);
  return timing;
}

class SimulatedDrive {
 public:
  SimulatedDrive(const DriveCase& drive, Transport transport, const sim::AxisParameters& parameters = good_axis(),
                 const sim::LineTiming& timing = {})
      : case_(drive),
        axis_(parameters),
        drive_(sim::make_drive(drive.kind, axis_)),
        line_(transport, *drive_, faults_, drive_.get(), timing) {}

  [[nodiscard]] sim::AxisModel& axis() { return axis_; }
  [[nodiscard]] sim::SimDrive& drive() { return *drive_; }
  [[nodiscard]] sim::FaultScript& faults() { return faults_; }
  [[nodiscard]] SimulatedLine& line() { return line_; }

  /// As a master does that does not share the line; starts nothing. False if the drive refuses it.
  [[nodiscard]] bool write_target_as_another_master(std::int32_t steps) {
    const auto bits = static_cast<std::uint32_t>(steps);
    const std::array<std::uint16_t, 2> words{static_cast<std::uint16_t>(bits >> 16U),
                                             static_cast<std::uint16_t>(bits & 0xFFFFU)};
    return drive_->write(target_address(case_.kind), words) == sim::ModbusException::kNone;
  }

  [[nodiscard]] StageConfig config() const {
    const ModbusLinkConfig link = line_.config();
    StageConfig config;
    config.profile = std::string(FVD_SOURCE_DIR "/config/drives/") + case_.profile;
    if (const auto* serial = std::get_if<ModbusSerialEndpoint>(&link.endpoint)) {
      config.transport = "rtu";
      config.serial_device = serial->device;
    } else {
      config.port = std::get<ModbusTcpEndpoint>(link.endpoint).port;
    }
    config.response_timeout = link.response_timeout;
    config.quiet = link.quiet;
    config.min = Micrometers{-500.0};
    config.max = Micrometers{1500.0};
    config.simulated = true;
    return config;
  }
  [[nodiscard]] std::unique_ptr<Axis> open() const { return open_modbus_stage(config()); }
  [[nodiscard]] std::unique_ptr<Axis> open_homed() const {
    auto stage = open();
    stage->home({});
    return stage;
  }

 private:
  const DriveCase case_;
  sim::AxisModel axis_;
  std::unique_ptr<sim::SimDrive> drive_;
  sim::FaultScript faults_;
  SimulatedLine line_;
};

}  // namespace fvd::test
