#include "daemon/ctl/study_options.hpp"

#include <chrono>

#include <CLI/CLI.hpp>

#include "config/field_writer.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/study_scans.hpp"
#include "daemon/ctl/study_text.hpp"
#include "daemon/study/study_input.hpp"

namespace fvd::ctl {

namespace {

/// The daemon gives a study up after five minutes.
constexpr std::chrono::seconds kLongestStudy{330};

/// As the daemon's reply has it, without what only a study that is kept has.
Json offline_reply(const Desk& desk, const std::string& method, const Json& params) {
  desk.terminal.err << "fvdctl: the study is of folders, without a daemon: nothing is kept" << std::endl;
  Study study = study_of_folders(read_study_request(method, params.dump()), desk.a.calibration);
  const auto described = fields_to_json([&study](Fields& fields) { describe(study, fields); });
  return {{"study", Json::parse(described.dump())}, {"kept", false}};
}

void add_calibration_option(CLI::App& sub, StudyArguments& a) {
  sub.add_option("--calibration", a.calibration,
                 "folder of calibration.json, for the reference maps that results in folders name")
      ->check(CLI::ExistingDirectory);
}

}  // namespace

void put_evaluated(const StudyArguments& a, Json& params) {
  if (!a.evaluate_by.empty()) params["recipe"] = a.evaluate_by;
  if (a.require_calibration) params["require_calibration"] = true;
}

void put_region(const StudyArguments& a, Json& params) {
  if (!a.region_um.empty()) {
    params["region"]["rectangle_um"] = {
        {"x", a.region_um[0]}, {"y", a.region_um[1]}, {"width", a.region_um[2]}, {"height", a.region_um[3]}};
  }
  if (!a.circle_um.empty()) {
    params["region"]["circle_um"] = {{"x", a.circle_um[0]}, {"y", a.circle_um[1]}, {"radius", a.circle_um[2]}};
  }
}

std::vector<std::string> jobs_of(const Desk& desk) {
  const StudyArguments& a = desk.a;
  const int ways =
      (a.jobs.empty() ? 0 : 1) + (a.jobs_file.empty() ? 0 : 1) + (a.scans == 0 ? 0 : 1) + (a.folders.empty() ? 0 : 1);
  if (ways != 1)
    throw UsageError("give job ids, or --jobs-file, or --folder, or --scans with --part where it is known");
  if (!a.folders.empty()) return a.folders;
  if (!a.jobs.empty()) return a.jobs;
  if (!a.jobs_file.empty()) return read_jobs_file(a.jobs_file);
  if (a.part.empty()) throw UsageError("--scans needs --part");
  RpcClient client = desk.connect();
  return scan_often(client, {a.scan_recipe, a.part, desk.client}, a.scans, desk.terminal);
}

int finish(const Desk& desk, const std::string& method, Json params) {
  const bool offline = desk.a.offline || !desk.a.folders.empty();
  if (!offline && !desk.a.calibration.empty())
    throw UsageError("--calibration is for folders; the daemon knows its own");
  if (!desk.a.person.empty()) params["person"] = desk.a.person;
  const Json reply = offline ? offline_reply(desk, method, params) : desk.connect().call(method, params, kLongestStudy);
  desk.terminal.out << (desk.a.json ? reply.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                                    : study_text(reply))
                    << std::flush;
  return study_exit_code(reply);
}

CLI::App* add(CLI::App& parent, const Desk& desk, const char* name, const char* help, std::function<int()> run) {
  CLI::App* sub = parent.add_subcommand(name, help);
  sub->callback([&chosen = desk.chosen, run = std::move(run)] { chosen = run; });
  sub->add_flag("--json", desk.a.json, "print JSON");
  return sub;
}

CLI::App* add_asked(CLI::App& parent, const Desk& desk, const char* name, const char* help, std::function<int()> run) {
  CLI::App* sub = add(parent, desk, name, help, std::move(run));
  sub->add_option("--person", desk.a.person, "who asks for it");
  return sub;
}

void add_job_options(CLI::App& sub, StudyArguments& a, std::optional<ScanCounts> scans) {
  sub.add_option("jobs", a.jobs, "job ids");
  sub.add_option("--folder", a.folders, "folders of results in place of jobs: without a daemon, nothing is kept")
      ->check(CLI::ExistingDirectory);
  add_calibration_option(sub, a);
  sub.add_option("--jobs-file", a.jobs_file, "file with a job id a line")->check(CLI::ExistingFile);
  if (scans) {
    sub.add_option("--scans", a.scans, "start so many jobs first; MOVES the stage")
        ->check(CLI::Range(scans->least, scans->most));
  }
  sub.add_option("--recipe", a.scan_recipe, "recipe of the jobs that are started; default: the prepared one");
  sub.add_option("--part", a.part, "part id of the jobs that are started");
}

void add_value_options(CLI::App& sub, StudyArguments& a) {
  sub.add_option("--measurement", a.measurement, "its name in the recipe")->capture_default_str();
  sub.add_option("--value", a.value, "of the measurement, as height_um");
  sub.add_option("--evaluate-by", a.evaluate_by, "recipe whose evaluation the surfaces are given to anew");
  sub.add_flag("--require-calibration", a.require_calibration, "refuse jobs that were measured without constants");
}

void add_region_options(CLI::App& sub, StudyArguments& a) {
  sub.add_option("--region-um", a.region_um, "x,y,width,height of the part of the field that counts")
      ->delimiter(',')
      ->expected(4);
  sub.add_option("--circle-um", a.circle_um, "x,y,radius of the part that counts")->delimiter(',')->expected(3);
}

void add_offline_option(CLI::App& sub, StudyArguments& a) {
  sub.add_flag("--offline", a.offline, "each JOB is the folder of a result: without a daemon, nothing is kept");
  add_calibration_option(sub, a);
}

}  // namespace fvd::ctl
