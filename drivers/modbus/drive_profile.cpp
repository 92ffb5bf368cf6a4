#include "drivers/modbus/drive_profile.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "drivers/modbus/drive_document.hpp"

namespace fvd {

std::int64_t DriveUnit::value(double physical) const {
  const double exact = inverse ? factor / physical : factor * physical;
  return std::clamp(static_cast<std::int64_t>(std::clamp(std::round(exact), -9e15, 9e15)), min, max);
}

std::vector<DriveAlarm> alarms_of(const DriveProfile& profile, int code) {
  std::vector<DriveAlarm> found;
  if (!profile.alarms_are_bits) {
    const auto known = profile.alarms.find(code);
    if (known != profile.alarms.end()) found.push_back(known->second);
    return found;
  }
  auto bits = static_cast<std::uint32_t>(code);
  for (const auto& [bit, alarm] : profile.alarms) {
    const auto mask = static_cast<std::uint32_t>(bit);
    if (mask == 0 || (bits & mask) != mask) continue;
    bits &= ~mask;
    found.push_back(alarm);
  }
  if (bits != 0 && !found.empty()) found.push_back({"further bits, see the drive's manual"});
  return found;
}

std::string alarm_text(const DriveProfile& profile, int code) {
  std::ostringstream text;
  text << "alarm 0x" << std::hex << std::uppercase << code;
  const std::vector<DriveAlarm> known = alarms_of(profile, code);
  if (known.empty()) return text.str() + ": see the drive's manual";
  const char* separator = ": ";
  for (const DriveAlarm& alarm : known) {
    text << std::exchange(separator, ", ") << alarm.text;
    if (!alarm.resettable) text << " (not resettable: switch the drive off and on)";
    if (alarm.position_lost) text << " (position lost: home again)";
  }
  return text.str();
}

DriveProfile parse_drive_profile(std::string_view json_text, const std::string& source) {
  Problems problems;
  DriveDocument document;
  DriveProfile profile;
  if (const auto json = parse_strict_json(json_text, problems)) {
    FieldReader reader(*json, problems);
    describe(document, reader);
    reader.finish();
    if (json->is_object()) profile = build_drive_profile(document, problems);
  }
  throw_if_any(problems, ErrorCode::kBadConfig, source);
  return profile;
}

DriveProfile load_drive_profile(const std::filesystem::path& file) {
  return parse_drive_profile(read_text_file(file), file.string());
}

std::string drive_profile_schema_text() {
  DriveDocument defaults;
  const auto schema = fields_to_schema([&](Fields& fields) { describe(defaults, fields); }, "fvd drive profile");
  return schema.dump(2) + "\n";
}

}  // namespace fvd
