#include "daemon/ctl/study_commands.hpp"

#include <stdexcept>

#include <CLI/CLI.hpp>

#include "core/base/error.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/study_artefact_commands.hpp"
#include "daemon/ctl/study_options.hpp"
#include "daemon/ctl/study_scans.hpp"
#include "daemon/ctl/study_text.hpp"

namespace fvd::ctl {

namespace {

int run_maps(const Desk& desk, const std::string& method) {
  Json params{{"jobs", jobs_of(desk)}};
  put(params, "s_nesting_um", desk.a.s_nesting_um);
  put_region(desk.a, params);
  return finish(desk, method, params);
}

/// "JOB=1,2": the job and exactly `count` numbers.
std::pair<std::string, std::vector<double>> split_step(const std::string& text, std::size_t count, const char* form) {
  const auto equals = text.rfind('=');
  std::vector<double> numbers;
  bool good = equals != std::string::npos && equals > 0;
  std::string rest = good ? text.substr(equals + 1) : "";
  while (good && !rest.empty()) {
    const auto comma = std::min(rest.find(','), rest.size());
    try {
      std::size_t used = 0;
      numbers.push_back(std::stod(rest.substr(0, comma), &used));
      good = used == comma;
    } catch (const std::exception&) {
      good = false;
    }
    rest = comma < rest.size() ? rest.substr(comma + 1) : "";
  }
  if (!good || numbers.size() != count) throw UsageError("--step: '" + text + "' is not " + form);
  return {text.substr(0, equals), numbers};
}

int run_steps(const Desk& desk, const std::string& method) {
  Json params{{"steps", Json::array()}};
  for (const std::string& text : desk.a.steps) {
    const auto [job, numbers] = split_step(text, 2, "JOB=REFERENCE_UM,U_UM");
    Json step{{"job", job},
              {"measurement", desk.a.measurement},
              {"reference_um", numbers[0]},
              {"u_reference_um", numbers[1]}};
    put(step, "value", desk.a.value);
    params["steps"].push_back(std::move(step));
  }
  put(params, "u_common_relative", desk.a.u_common_relative);
  put_evaluated(desk.a, params);
  return finish(desk, method, params);
}

int run_linearity(const Desk& desk) {
  Json params{{"steps", Json::array()}};
  for (const std::string& text : desk.a.steps) {
    const auto [job, numbers] = split_step(text, 1, "JOB=Z_UM");
    Json step{{"job", job}, {"measurement", desk.a.measurement}, {"z_um", numbers[0]}};
    put(step, "value", desk.a.value);
    params["steps"].push_back(std::move(step));
  }
  put_evaluated(desk.a, params);
  return finish(desk, "verify.linearity", params);
}

int run_type1(const Desk& desk) {
  const StudyArguments& a = desk.a;
  Json params{{"jobs", jobs_of(desk)}, {"measurement", a.measurement}};
  put(params, "value", a.value);
  put(params, "reference", a.reference);
  put(params, "tolerance", a.tolerance);
  put(params, "resolution", a.resolution);
  put(params, "required", a.required);
  put_evaluated(a, params);
  return finish(desk, "gauge.type1", params);
}

std::vector<std::string> crossed_jobs(const Desk& desk) {
  const StudyArguments& a = desk.a;
  RpcClient client = desk.connect();
  return scan_crossed(client, {a.scan_recipe, a.part, desk.client}, a.parts, a.operators, a.trials, desk.terminal);
}

int run_rr(const Desk& desk) {
  const StudyArguments& a = desk.a;
  const bool given = !a.jobs.empty() || !a.jobs_file.empty() || !a.folders.empty();
  const std::vector<std::string> jobs = given ? jobs_of(desk) : crossed_jobs(desk);
  Json params{{"parts", a.parts},
              {"operators", a.operators},
              {"trials", a.trials},
              {"jobs", jobs},
              {"measurement", a.measurement}};
  put(params, "value", a.value);
  put(params, "tolerance", a.tolerance);
  put_evaluated(a, params);
  return finish(desk, "gauge.rr", params);
}

int run_capability(const Desk& desk) {
  Json params{{"type1", desk.a.type1}, {"rr", desk.a.rr}};
  put(params, "tolerance", desk.a.tolerance);
  put(params, "u_calibration", desk.a.u_calibration);
  return finish(desk, "gauge.capability", params);
}

int print(const Desk& desk, const Json& reply) {
  desk.terminal.out << reply.dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
  return kExitOk;
}

int run_accept(const Desk& desk) {
  const StudyArguments& a = desk.a;
  Json params{{"study", a.study}, {"person", a.person}, {"renew_by", a.renew_by}};
  if (!a.certificate.empty()) params["certificate"] = a.certificate;
  RpcClient client = desk.connect();
  const Json reply = client.call("calibrate.accept", params);
  if (a.json) return print(desk, reply);
  desk.terminal.out << reply.value("calibration", "")
                    << (reply.value("already", false) ? " had been made of it already" : " is in force now")
                    << std::endl;
  return kExitOk;
}

void add_map_command(CLI::App& parent, const Desk& desk, const char* name, const std::string& method,
                     const char* help) {
  CLI::App* sub = add_asked(parent, desk, name, help, [desk, method] { return run_maps(desk, method); });
  const bool flatness = std::string(name) == "flatness";
  add_job_options(*sub, desk.a, ScanCounts{flatness ? 1 : 2, 20});
  add_region_options(*sub, desk.a);
  if (flatness) {
    sub->add_option("--s-nesting-um", desk.a.s_nesting_um, "S-filter that each map is given to first");
  }
}

void add_step_command(CLI::App& parent, const Desk& desk, const char* name, const std::string& method,
                      const char* help) {
  CLI::App* sub = add_asked(parent, desk, name, help, [desk, method] { return run_steps(desk, method); });
  sub->add_option("--step", desk.a.steps, "JOB=REFERENCE_UM,U_UM; once for each job")->required();
  sub->add_option("--u-common-relative", desk.a.u_common_relative,
                  "part of the certificates' uncertainty that all steps share, over the height");
  add_value_options(*sub, desk.a);
  add_offline_option(*sub, desk.a);
}

void add_gauge_commands(CLI::App& app, const Desk& desk) {
  CLI::App* gauge = app.add_subcommand("gauge", "studies of the gauge");
  gauge->require_subcommand(1);
  CLI::App* sub = add_asked(*gauge, desk, "type1", "bias, Cg, Cgk of one part", [desk] { return run_type1(desk); });
  add_job_options(*sub, desk.a, ScanCounts{2, 1000});
  add_value_options(*sub, desk.a);
  sub->add_option("--reference", desk.a.reference, "true value of the part")->required();
  sub->add_option("--tolerance", desk.a.tolerance, "upper less lower limit")->required();
  sub->add_option("--resolution", desk.a.resolution, "smallest step of the value");
  sub->add_option("--required", desk.a.required, "of Cg and Cgk");
  sub = add_asked(*gauge, desk, "rr",
                  "parts x operators x trials; without job ids it asks for each part and MOVES the stage",
                  [desk] { return run_rr(desk); });
  add_job_options(*sub, desk.a);
  add_value_options(*sub, desk.a);
  sub->add_option("--parts", desk.a.parts, "how many")->required()->check(CLI::Range(2, 1000));
  sub->add_option("--operators", desk.a.operators, "how many")->required()->check(CLI::Range(1, 100));
  sub->add_option("--trials", desk.a.trials, "of each part by each operator")->required()->check(CLI::Range(2, 100));
  sub->add_option("--tolerance", desk.a.tolerance, "upper less lower limit");
  sub = add_asked(*gauge, desk, "capability", "Q_MS and Q_MP of VDA 5 from two studies",
                  [desk] { return run_capability(desk); });
  sub->add_option("--type1", desk.a.type1, "id of a study of gauge type1")->required();
  sub->add_option("--rr", desk.a.rr, "id of a study of gauge rr")->required();
  sub->add_option("--tolerance", desk.a.tolerance, "default: that of the type 1 study");
  sub->add_option("--u-calibration", desk.a.u_calibration, "standard uncertainty of the reference");
}

void add_reading_commands(CLI::App& app, const Desk& desk) {
  CLI::App* study = app.add_subcommand("study", "the studies that were made");
  study->require_subcommand(1);
  CLI::App* sub = add(*study, desk, "list", "all of them, the newest first", [desk] {
    RpcClient client = desk.connect();
    const Json reply = client.call("study.list", {{"kind", desk.a.kind}});
    if (desk.a.json) return print(desk, reply);
    desk.terminal.out << study_list_text(reply) << std::flush;
    return kExitOk;
  });
  sub->add_option("--kind", desk.a.kind, "only of this kind, or beginning with it");
  sub = add(*study, desk, "get", "one of them", [desk] {
    RpcClient client = desk.connect();
    const Json reply = client.call("study.get", {{"id", desk.a.study}});
    if (desk.a.json) return print(desk, reply);
    desk.terminal.out << study_text(reply) << std::flush;
    return kExitOk;
  });
  sub->add_option("study", desk.a.study, "its id")->required();
  sub = add(app, desk, "calibration", "the constants of the instrument", [desk] {
    RpcClient client = desk.connect();
    return print(desk, client.call("calibration.get", {{"id", desk.a.version}, {"objective", desk.a.objective}}));
  });
  sub->add_option("version", desk.a.version, "its id; default: the newest");
  sub->add_option("--objective", desk.a.objective, "whose constants");
}

}  // namespace

void add_study_commands(CLI::App& app, StudyArguments& arguments, const std::function<RpcClient()>& connect,
                        const std::string& client, const Terminal& terminal, std::function<int()>& chosen) {
  const Desk desk{arguments, connect, client, terminal, chosen};
  CLI::App* verify = app.add_subcommand("verify", "self tests: measure and report, change nothing");
  verify->require_subcommand(1);
  add_map_command(*verify, desk, "noise", "verify.noise", "measurement noise N_M, from scans of one part");
  add_map_command(*verify, desk, "flatness", "verify.flatness", "flatness deviation z_FLT, from scans of a flat");
  add_step_command(*verify, desk, "step", "verify.step", "alpha_z and l_z, from steps of known height");
  CLI::App* sub = add_asked(*verify, desk, "linearity", "l_z over the range, from one step at several z",
                            [desk] { return run_linearity(desk); });
  sub->add_option("--step", arguments.steps, "JOB=Z_UM; once for each job")->required();
  add_value_options(*sub, arguments);
  add_offline_option(*sub, arguments);
  add_verifying_artefacts(*verify, desk);
  CLI::App* calibrate = app.add_subcommand("calibrate", "propose constants of the instrument, and accept them");
  calibrate->require_subcommand(1);
  add_map_command(*calibrate, desk, "noise", "calibrate.noise", "propose the measurement noise");
  add_map_command(*calibrate, desk, "flatness", "calibrate.flatness", "propose the reference map of a flat");
  add_step_command(*calibrate, desk, "z", "calibrate.z", "propose alpha_z and l_z");
  add_calibrating_artefacts(*calibrate, desk);
  sub = add(*calibrate, desk, "accept", "make a study's constants valid", [desk] { return run_accept(desk); });
  sub->add_option("study", arguments.study, "its id")->required();
  sub->add_option("--person", arguments.person, "who accepts them")->required();
  sub->add_option("--renew-by", arguments.renew_by, "the last day that they are trusted on, as 2027-11-29")->required();
  sub->add_option("--certificate", arguments.certificate, "number of the artefact's certificate");
  add_gauge_commands(app, desk);
  add_reading_commands(app, desk);
}

}  // namespace fvd::ctl
