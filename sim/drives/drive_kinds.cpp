#include "sim/drives/drive_kinds.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "sim/drives/ar_drive.hpp"
#include "sim/drives/az_drive.hpp"
#include "sim/drives/cia402_drive.hpp"
#include "sim/drives/leadshine_drive.hpp"
#include "sim/drives/scl_drive.hpp"

namespace fvd::sim {

const std::vector<std::string>& drive_names() {
  static const std::vector<std::string> kNames{"az", "ar", "leadshine", "scl", "cia402"};
  return kNames;
}

DriveKind drive_kind(const std::string& name) {
  const auto& names = drive_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error(ErrorCode::kBadConfig, "there is no simulated drive '" + name + "'");
  return static_cast<DriveKind>(found - names.begin());
}

std::unique_ptr<SimDrive> make_drive(DriveKind kind, AxisModel& axis, DriveClock clock) {
  switch (kind) {
    case DriveKind::kAz:
      return std::make_unique<AzDrive>(axis, std::move(clock));
    case DriveKind::kAr:
      return std::make_unique<ArDrive>(axis, std::move(clock));
    case DriveKind::kLeadshine:
      return std::make_unique<LeadshineDrive>(axis, std::move(clock));
    case DriveKind::kScl:
      return std::make_unique<SclDrive>(axis, std::move(clock));
    case DriveKind::kCia402:
      return std::make_unique<Cia402Drive>(axis, std::move(clock));
  }
  throw Error(ErrorCode::kInternal, "unknown drive kind");
}

}  // namespace fvd::sim
