#pragma once

/// The drives that can be simulated, by name.

#include <memory>
#include <string>
#include <vector>

#include "sim/drives/sim_drive.hpp"

namespace fvd::sim {

enum class DriveKind { kAz, kAr, kLeadshine, kScl, kCia402 };

/// "az", "ar", "leadshine", "scl", "cia402", in the order of the kinds.
[[nodiscard]] const std::vector<std::string>& drive_names();
/// Throws Error kBadConfig for an unknown name.
[[nodiscard]] DriveKind drive_kind(const std::string& name);

/// A drive of this kind with its factory settings: Leadshine with 10000 pulses per turn, SCL with 20000 steps per turn.
/// axis outlives the drive.
[[nodiscard]] std::unique_ptr<SimDrive> make_drive(DriveKind kind, AxisModel& axis, DriveClock clock = HostClock::now);

}  // namespace fvd::sim
