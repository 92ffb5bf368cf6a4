#include "daemon/ctl/stage_command.hpp"

#include <algorithm>
#include <iomanip>
#include <optional>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/stage/stage_report.hpp"
#include "daemon/base/version.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/stop_on_signal.hpp"
#include "daemon/devices/standstill.hpp"
#include "daemon/export/stage_report_files.hpp"
#include "drivers/modbus/drive_check.hpp"
#include "drivers/modbus/modbus_axis.hpp"
#include "drivers/registry/driver_table.hpp"

namespace fvd::ctl {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kStopLooks = 5;  ///< of a second each; an axis slows down within less

void resolve_endpoint(StageArguments& arguments) {
  StageConfig& stage = arguments.stage;
  stage.response_timeout = std::chrono::milliseconds(arguments.response_timeout_ms);
  const bool is_gcs = !arguments.gcs_axis.empty();
  if (!is_gcs && stage.profile.empty()) throw UsageError("give the drive's profile, or --gcs-axis");
  if (is_gcs) {
    stage.driver = "gcs";
    stage.gcs_axis = arguments.gcs_axis;
  }
  if (arguments.tcp.empty() == stage.serial_device.empty()) {
    throw UsageError("give the drive's line: --tcp HOST[:PORT] or --serial DEVICE");
  }
  if (arguments.tcp.empty()) {
    stage.transport = is_gcs ? "serial" : "rtu";
    return;
  }
  stage.transport = "tcp";
  const auto colon = arguments.tcp.rfind(':');
  stage.address = arguments.tcp.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string port = arguments.tcp.substr(colon + 1);
  const bool digits = !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::stoi(port) < 1 || std::stoi(port) > 65535) {
    throw UsageError("--tcp " + arguments.tcp + ": expected HOST or HOST:PORT with a port of 1..65535");
  }
  stage.port = std::stoi(port);
}

const char* yes_no(const std::optional<bool>& holds) { return !holds ? "unknown" : *holds ? "yes" : "no"; }

/// "unknown" where the drive did not tell whether it has one.
std::string alarm_text(const DriveCheck& check) {
  if (!check.alarm.empty()) return check.alarm;
  const auto told = std::find_if(check.status.begin(), check.status.end(),
                                 [](const DriveCheck::Statement& statement) { return statement.name == "alarm"; });
  return told != check.status.end() && !told->holds ? "unknown" : "none";
}

Json json_of(const DriveCheck& check, const DriveProfile& profile, const std::string& line) {
  Json json{{"profile", profile.name}, {"line", line}};
  json["position_um"] = check.position_um ? Json(*check.position_um) : Json();
  for (const auto& statement : check.identity) json["identity"][statement.name] = yes_no(statement.holds);
  for (const auto& statement : check.status) json["status"][statement.name] = yes_no(statement.holds);
  json["alarm"] = check.alarm.empty() ? Json() : Json(check.alarm);
  for (const auto& temperature : check.temperatures) json["temperatures_c"][temperature.name] = temperature.celsius;
  for (const auto& reg : check.registers) {
    Json entry{{"address", reg.address}, {"value", nullptr}};
    if (reg.value) entry["value"] = *reg.value;
    if (!reg.error.empty()) entry["error"] = reg.error;
    json["registers"][reg.name] = entry;
  }
  json["link"] = {{"requests", check.link.transactions},
                  {"unanswered", check.link.unknown},
                  {"refused", check.link.rejected},
                  {"put_off", check.link.later},
                  {"latency_p50_us", check.link.latency_p50_us},
                  {"latency_max_us", check.link.latency_max_us}};
  json["disagreements"] = check.disagreements;
  json["doubts"] = check.doubts;
  return json;
}

std::string text_of(const DriveCheck& check, const DriveProfile& profile, const std::string& line) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  text << "drive     " << profile.name << " at " << line << "\n";
  for (const auto& statement : check.identity)
    text << "identity  " << statement.name << ": " << yes_no(statement.holds) << "\n";
  text << "position  ";
  if (check.position_um) {
    text << *check.position_um << " um\nstatus   ";
  } else {
    text << "unknown\nstatus   ";
  }
  for (const auto& statement : check.status) text << ' ' << statement.name << ' ' << yes_no(statement.holds) << ',';
  text.seekp(-1, std::ios_base::end);
  text << "\nalarm     " << alarm_text(check) << "\n" << std::setprecision(1);
  for (const auto& temperature : check.temperatures) {
    text << "temperature of " << temperature.name << " " << temperature.celsius << " degC\n";
  }
  text << "link      " << check.link.transactions << " requests, " << check.link.unknown << " unanswered, "
       << check.link.latency_p50_us / 1000.0 << " ms median\nregisters\n";
  for (const auto& reg : check.registers) {
    text << "  " << std::left << std::setw(24) << reg.name << std::right << std::setw(6) << reg.address << "  "
         << (reg.value ? std::to_string(*reg.value) : reg.error) << "\n";
  }
  if (check.disagreements.empty()) {
    text << "The drive fits the profile.\n";
  } else {
    text << "The drive disagrees with the profile:\n";
    for (const auto& one : check.disagreements) text << "  * " << one << "\n";
  }
  for (const auto& one : check.doubts) text << "To look at: " << one << "\n";
  return text.str();
}

void print_report(std::ostream& out, const Json& report, const std::filesystem::path& folder) {
  out << report.dump(2) << "\nfiles in " << folder.string() << std::endl;
}

}  // namespace

int run_stage_check(StageArguments arguments, const Terminal& terminal) {
  resolve_endpoint(arguments);
  const DriveProfile profile = load_drive_profile(arguments.stage.profile);
  ModbusLink link(modbus_link_config(arguments.stage));
  const DriveCheck check = check_drive(profile, link);
  if (arguments.json) {
    terminal.out << json_of(check, profile, link.description()).dump(2) << std::endl;
  } else {
    terminal.out << text_of(check, profile, link.description()) << std::flush;
  }
  return check.disagreements.empty() ? kExitOk : kExitBadData;
}

int run_stage_accuracy(StageArguments arguments, const Terminal& terminal) {
  resolve_endpoint(arguments);
  if (std::filesystem::exists(arguments.out)) {
    throw Error(ErrorCode::kStorageWrite,
                arguments.out.string() + " exists already: give another name, or move it away");
  }
  const StopOnSignal signal;
  const auto stage = open_stage(arguments.stage);
  if (!stage->status().homed) {
    if (!arguments.home) throw Error(ErrorCode::kStageNotHomed, "the stage has no reference; --home finds it first");
    stage->home(signal.token());
  }
  SystemClock clock;
  int shown = -1;
  const auto progress = [&](int done, int all) {
    const int percent = 100 * done / all;
    if (percent / 10 == shown / 10 && shown >= 0) return;
    shown = percent;
    terminal.err << "position " << done << "/" << all << std::endl;
  };
  const auto points = run_stage(*stage, clock, arguments.plan, progress, signal.token());
  const StageInfo info = stage->info();
  StageReportOptions options;
  options.feedback = info.feedback;
  options.step_quantum_um = info.step_quantum.value;
  options.feedback_resolution_um = info.feedback_resolution.value;
  const double lead_um = arguments.lead_um > 0.0 ? arguments.lead_um : info.lead.value;
  if (lead_um > 0.0) options.lead_um = lead_um;
  const StageReport report = make_stage_report(points, options);
  StageReportHeader header{info.name, info.address, std::chrono::system_clock::now(), kVersion, std::nullopt};
  if (info.simulated) header.simulated = true;  // a line does not tell a simulator from a drive
  write_stage_report(arguments.out, points, report, header);
  print_report(terminal.out, Json::parse(stage_report_json(report, header)), arguments.out);
  if (const auto link = stage->link_stats()) {
    terminal.err << "link: " << link->requests << " requests, " << link->retries << " retries, " << link->unanswered
                 << " unanswered, " << link->put_off << " put off, p50 " << link->latency_p50_us / 1000.0 << " ms, p99 "
                 << link->latency_p99_us / 1000.0 << " ms" << std::endl;
  }
  return kExitOk;
}

int run_stage_stop(const std::filesystem::path& config_file, const Terminal& terminal) {
  const LoadedConfig loaded = load_config(config_file);
  if (!loaded.problems.empty()) {
    terminal.err << to_text(loaded.problems, config_file.string()) << std::endl;
    return kExitConfig;
  }
  if (loaded.config.stage.driver == "replay") {
    terminal.out << "recorded slices have no axis: there is nothing to stop" << std::endl;
    return kExitOk;
  }
  const auto stage = open_stage(loaded.config.stage);  // stops one that moves
  SystemClock clock;
  for (int look = 0; look < kStopLooks; ++look) {
    if (const auto rest = bring_to_rest(*stage, clock, [] {})) {
      terminal.out << "the stage stands still at " << rest->value << " um" << std::endl;
      return kExitOk;
    }
  }
  throw Error(ErrorCode::kStagePosition, "the stage was told to stop and still moves: switch the drive off");
}

}  // namespace fvd::ctl
