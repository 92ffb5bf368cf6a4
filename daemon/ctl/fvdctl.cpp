#include "daemon/ctl/fvdctl.hpp"

#include <charconv>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "core/base/error.hpp"
#include "daemon/base/version.hpp"
#include "daemon/ctl/access_commands.hpp"
#include "daemon/ctl/backup_commands.hpp"
#include "daemon/ctl/connection.hpp"
#include "daemon/ctl/device_commands.hpp"
#include "daemon/ctl/evaluation_text.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/export_command.hpp"
#include "daemon/ctl/history_commands.hpp"
#include "daemon/ctl/job_commands.hpp"
#include "daemon/ctl/measure_command.hpp"
#include "daemon/ctl/objective_commands.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/recipe_commands.hpp"
#include "daemon/ctl/report_command.hpp"
#include "daemon/ctl/rpc_client.hpp"
#include "daemon/ctl/setup_command.hpp"
#include "daemon/ctl/stage_command.hpp"
#include "daemon/ctl/study_commands.hpp"
#include "daemon/ctl/suggest_command.hpp"
#include "daemon/ctl/suggest_confocal.hpp"
#include "daemon/ctl/wrong_words.hpp"

namespace fvd::ctl {

namespace {

constexpr std::chrono::seconds kCommandTimeout{330};  ///< the daemon gives a command up after 5 minutes

/// The options of all commands; CLI11 fills them.
struct Arguments {
  ConnectionArguments connection;
  AccessArguments access;
  JobsArguments jobs;
  std::string job;
  std::string seq = "auto";
  std::string client = kClientName;
  StartOptions start;
  bool watch = false;
  std::string format = "compact";
  std::string method;
  std::string params = "{}";
  ProcessArguments process;
  ExportArguments to_file;
  MeasureArguments measure;
  ReportArguments report;
  std::string suggest_source;
  StackChoice suggest_choice;
  ConfocalOptics suggest_optics;
  StageArguments stage;
  DevicesArguments devices;
  SetupArguments setup;
  RecipeArguments recipe;
  ObjectiveArguments objective;
  BackupArguments backup;
  StudyArguments study;
};

void print(std::ostream& out, const Json& json) {
  out << json.dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
}

int fail(const Terminal& terminal, const std::string& message, int code) {
  terminal.err << "fvdctl: " << message << std::endl;
  return code;
}

/// Says how a job ended; the reason of a failure goes to err.
int report_end(const Json& status, const Terminal& terminal) {
  const int code = job_exit_code(status);
  if (code == kExitOk) return code;
  const auto text = [&status](const char* key) {
    return status.contains(key) && status[key].is_string() ? status[key].get<std::string>() : std::string("unknown");
  };
  terminal.err << "fvdctl: job " << text("job_id") << " " << text("state") << ": ";
  if (text("error") != text("state")) terminal.err << text("error") << ": ";  // "aborted: aborted: .."
  terminal.err << text("error_message") << std::endl;
  return code;
}

int state(const Arguments& arguments, const Terminal& terminal) {
  RpcClient client = connect(arguments.connection);
  print(terminal.out, client.call("system.state"));
  return kExitOk;
}

int start(Arguments& arguments, const Terminal& terminal) {
  if (arguments.seq != "auto") {
    arguments.start.seq = std::stoll(arguments.seq);  // digits only, checked by the parser
  }
  RpcClient client = connect(arguments.connection);
  const Json job = start_job(client, arguments.start, arguments.client);
  print(terminal.out, job);
  if (!arguments.watch) return kExitOk;
  return report_end(watch_job(client, job_key(client, job.value("job_id", "")), terminal.out, terminal.out_is_terminal),
                    terminal);
}

int wait(const Arguments& arguments, const Terminal& terminal) {
  RpcClient client = connect(arguments.connection);
  const Json status = wait_for_job(client, job_key(client, arguments.job, arguments.client));
  print(terminal.out, status);
  return report_end(status, terminal);
}

int watch(const Arguments& arguments, const Terminal& terminal) {
  RpcClient client = connect(arguments.connection);
  return report_end(
      watch_job(client, job_key(client, arguments.job, arguments.client), terminal.out, terminal.out_is_terminal),
      terminal);
}

int result(const Arguments& arguments, const Terminal& terminal) {
  RpcClient client = connect(arguments.connection);
  Json params = job_key(client, arguments.job, arguments.client);
  params["format"] = arguments.format;
  const Json reply = client.call("result.get", params);
  print(terminal.out, reply);
  if (reply.at("state") == "processing") {
    return fail(terminal, "the job has no result yet; 'fvdctl wait' waits for its end", kExitUnavailable);
  }
  if (job_exit_code(reply) == kExitOk) return kExitOk;
  return report_end(wait_for_job(client, {{"job_id", reply.at("job_id")}}), terminal);
}

int evaluate(const Arguments& arguments, const Terminal& terminal) {
  RpcClient client = connect(arguments.connection);
  Json params = job_key(client, arguments.job, arguments.client);
  params["recipe"] = arguments.start.recipe;
  const Json reply = client.call("result.evaluate", params, kCommandTimeout);
  print(terminal.out, reply);
  if (!reply.contains("verdict") || !reply["verdict"].is_string()) return kExitOk;
  return exit_code_of(verdict_from_name(reply["verdict"].get<std::string>()));
}

int rpc(const Arguments& arguments, const Terminal& terminal) {
  const Json params = Json::parse(arguments.params, nullptr, false);
  if (!params.is_object() && !params.is_array()) {
    throw Error(ErrorCode::kBadInput, "'" + arguments.params + "' is not a JSON object or array");
  }
  RpcClient client = connect(arguments.connection);
  print(terminal.out, client.call(arguments.method, params, kCommandTimeout));
  return kExitOk;
}

/// "auto" or 1..2^53-1.
std::string check_seq(const std::string& text) {
  if (text == "auto") return {};
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  constexpr long long kMaxSeq = (1LL << 53U) - 1;
  if (digits && text.size() <= 16 && std::stoll(text) >= 1 && std::stoll(text) <= kMaxSeq) return {};
  return "--seq: '" + text + "' is neither auto nor a number from 1 to 2^53-1";
}

/// A number of degrees as job.start takes it; "nan" is none.
std::string check_temperature(const std::string& text) {
  double celsius = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), celsius);
  const bool number = error == std::errc() && end == text.data() + text.size();
  if (number && celsius >= -50.0 && celsius <= 100.0) return {};
  return "--temperature-c: '" + text + "' is no number from -50 to 100";
}

using Command = std::function<int()>;

CLI::Option* add_line_options(CLI::App& sub, StageArguments& a) {
  CLI::Option* profile =
      sub.add_option("profile", a.stage.profile, "drive profile, a JSON file")->check(CLI::ExistingFile);
  CLI::Option* tcp = sub.add_option("--tcp", a.tcp, "HOST or HOST:PORT of the drive");
  sub.add_option("--serial", a.stage.serial_device, "serial port, best by its name in /dev/serial/by-id")
      ->excludes(tcp);
  sub.add_option("--baud", a.stage.serial_baud, "bit rate of the serial port")->capture_default_str();
  sub.add_option("--parity", a.stage.serial_parity, "parity of the serial port")
      ->check(CLI::IsMember({"none", "even", "odd"}))
      ->capture_default_str();
  sub.add_option("--stop-bits", a.stage.serial_stop_bits, "stop bits of the serial port")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  sub.add_option("--unit", a.stage.unit, "Modbus unit id")->check(CLI::Range(1, 247))->capture_default_str();
  sub.add_option("--response-timeout-ms", a.response_timeout_ms, "longest wait for the drive's answer")
      ->check(CLI::Range(10, 10000))
      ->capture_default_str();
  return profile;
}

/// A length in um as an option.
void add_length(CLI::App& sub, const char* name, Micrometers& value, const char* help) {
  sub.add_option(name, value.value, help)->capture_default_str();
}

void add_stage_commands(CLI::App& app, StageArguments& a, const Terminal& terminal, Command& chosen) {
  CLI::App* stage = app.add_subcommand("stage", "look at a drive, or measure it, without the daemon");
  stage->require_subcommand(1);
  CLI::App* check = stage->add_subcommand("check", "compare a drive with its profile; reads only, nothing moves");
  add_line_options(*check, a)->required();
  check->add_flag("--json", a.json, "print JSON");
  check->callback([&] { chosen = [&] { return run_stage_check(a, terminal); }; });

  CLI::App* accuracy = stage->add_subcommand("accuracy", "measure the stage's steps; MOVES the axis");
  CLI::Option* profile = add_line_options(*accuracy, a);
  accuracy->add_option("--gcs-axis", a.gcs_axis, "in place of a profile: this axis of a Physik Instrumente controller")
      ->excludes(profile);
  accuracy->add_option("--from-um", a.plan.from.value, "lowest position")->required();
  accuracy->add_option("--to-um", a.plan.to.value, "highest position")->required();
  accuracy->add_option("--steps", a.plan.steps, "number of steps between the two")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  accuracy->add_option("--repeats", a.plan.repeats, "how often the range is passed up and down")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  accuracy->add_option("--out", a.out, "folder for the report, must not exist")->required();
  accuracy->add_flag("--home", a.home, "home the axis first if it has no reference");
  accuracy->add_flag("--simulated", a.stage.simulated, "say in the report that the drive is a simulator");
  accuracy->add_option("--lead-um", a.lead_um, "screw lead, the period of its error; default: the profile's");
  add_length(*accuracy, "--min-um", a.stage.min, "lowest position the axis may go to");
  add_length(*accuracy, "--max-um", a.stage.max, "highest position the axis may go to");
  add_length(*accuracy, "--take-up-um", a.stage.take_up, "overshoot before each pass, at least 3 x backlash");
  add_length(*accuracy, "--window-um", a.plan.settle.window,
             "largest distance from the target at which the axis counts as settled");
  accuracy->add_option("--speed-um-per-s", a.stage.speed_um_per_s, "speed of moves")->capture_default_str();
  CLI::App* stop =
      stage->add_subcommand("stop", "stop the axis of a daemon that crashed, and see that it stands still");
  stop->add_option("--config", a.config_file, "configuration file of the daemon")->capture_default_str();
  stop->callback([&] { chosen = [&] { return run_stage_stop(a.config_file, terminal); }; });

  accuracy->callback([&] { chosen = [&] { return run_stage_accuracy(a, terminal); }; });
}

/// Commands that have commands of their own.
void add_command_groups(CLI::App& app, Arguments& a, const Terminal& terminal, Command& chosen) {
  add_stage_commands(app, a.stage, terminal, chosen);
  add_device_commands(app, a.devices, terminal, chosen);
  add_setup_command(app, a.setup, terminal, chosen);
  add_recipe_commands(
      app, a.recipe, [&a] { return connect(a.connection); }, terminal, chosen);
  add_study_commands(
      app, a.study, [&a] { return connect(a.connection); }, a.client, terminal, chosen);

  add_backup_commands(app, a.backup, terminal, chosen);
  add_objective_commands(
      app, a.objective, [&a] { return connect(a.connection); }, terminal, chosen);

  add_history_commands(
      app, a.jobs, [&a] { return connect(a.connection); }, terminal, chosen);

  add_access_commands(
      app, a.access, [&a] { return connect(a.connection); }, terminal, chosen);
}

void add_commands(CLI::App& app, Arguments& a, const Terminal& terminal, Command& chosen) {
  const auto command = [&app, &chosen](const char* name, const char* help, Command run) {
    CLI::App* sub = app.add_subcommand(name, help);
    sub->callback([&chosen, run = std::move(run)] { chosen = run; });
    return sub;
  };
  const char* const job_help = "job id, or sequence number (digits) of --client; default: the latest job";

  command("state", "print the state of the machine", [&] { return state(a, terminal); });

  CLI::App* sub = command("start", "start a job", [&] { return start(a, terminal); });
  sub->add_option("--seq", a.seq, "sequence number, the same number is the same job; auto: one after the highest")
      ->check(CLI::Validator(check_seq, "N|auto"))
      ->capture_default_str();
  sub->add_option("--part", a.start.part_id, "part id")->required();
  sub->add_option("--recipe", a.start.recipe, "recipe id; default: the prepared one");
  sub->add_option("--temperature-c", a.start.temperature_c, "of the part, degrees Celsius")
      ->check(CLI::Validator(check_temperature, "C in [-50 - 100]"));
  sub->add_flag("--watch", a.watch, "follow the job to its end");

  command("wait", "wait for the end of a job and print its status", [&] {
    return wait(a, terminal);
  })->add_option("job", a.job, job_help);
  command("watch", "follow a job to its end", [&] { return watch(a, terminal); })->add_option("job", a.job, job_help);

  sub = command("result", "print the result of a job", [&] { return result(a, terminal); });
  sub->add_option("job", a.job, job_help);
  sub->add_option("--format", a.format,
                  "compact: at most 440 bytes; full: at most 1400 bytes, and the warnings; complete: "
                  "result.json")
      ->check(CLI::IsMember({"compact", "full", "complete"}))
      ->capture_default_str();

  sub = command("evaluate", "evaluate a job's stored surface by another recipe: a new record; the job's result stays",
                [&] { return evaluate(a, terminal); });
  sub->add_option("job", a.job, job_help);
  sub->add_option("--recipe", a.start.recipe, "recipe id")->required();

  sub = command("rpc", "call any method and print what it returns", [&] { return rpc(a, terminal); });
  sub->add_option("method", a.method, "e.g. recipe.list")->required();
  sub->add_option("params", a.params, "JSON object or array")->capture_default_str();

  sub = command("process", "make a height map of recorded slices, without a daemon",
                [&] { return run_process(a.process, terminal); });
  add_process_options(*sub, a.process);

  sub = command("export", "write the surface of a result or of a file in another format, without a daemon",
                [&] { return run_export(a.to_file, terminal); });
  add_export_options(*sub, a.to_file);

  sub = command("measure", "evaluate the surface of a result or of a file as a recipe says, without a daemon",
                [&] { return run_measure(a.measure, terminal); });
  add_measure_options(*sub, a.measure);

  sub = command("report", "write the report of a result's folder as a PDF, without a daemon",
                [&] { return run_report(a.report, terminal); });
  add_report_options(*sub, a.report);

  add_command_groups(app, a, terminal, chosen);

  sub =
      command("suggest", "suggest a recipe's focus settings from recorded slices or one sharp image of a surface", [&] {
        return a.suggest_source.empty() ? run_suggest_confocal(a.suggest_optics, terminal)
                                        : run_suggest(a.suggest_source, a.suggest_choice, terminal);
      });
  CLI::Option* source = sub->add_option("source", a.suggest_source,
                                        "folder of slices, multi-page TIFF, or one image (PNG, TIFF, JPEG, PGM, BMP) "
                                        "where most of the surface is in focus");
  add_choice_options(*sub, a.suggest_choice);
  add_confocal_options(*sub, *source, a.suggest_optics);
}

int run(std::vector<std::string> arguments, const Terminal& terminal) {
  Arguments values;
  Command chosen;
  CLI::App app("fvdctl: client of the focus-variation daemon fvd", "fvdctl");
  app.set_version_flag("--version", std::string("fvdctl ") + kVersion);
  app.require_subcommand(1);
  CLI::Option* address = app.add_option("--address", values.connection.address,
                                        "host:port of the daemon, or http://host:port of its HTTP");
  app.add_option("--runtime-dir", values.connection.runtime_dir,
                 "where the daemon's rpc.json tells its socket and its port")
      ->excludes(address)
      ->capture_default_str();
  app.add_option("--token-file", values.connection.token_file, "say who calls by the token in this file")
      ->envname("FVD_TOKEN_FILE");
  app.add_option("--client", values.client, "whose sequence numbers are meant; a plain PLC is plc")
      ->capture_default_str();
  add_commands(app, values, terminal, chosen);
  try {
    std::reverse(arguments.begin(), arguments.end());  // the order CLI11 takes a vector in
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(app); !unknown.empty()) return fail(terminal, unknown, kExitUsage);
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
      return fail(terminal, unexpected_words(app), kExitUsage);
    }
    return app.exit(error, terminal.out, terminal.err) == 0 ? kExitOk : kExitUsage;
  }
  try {
    return chosen();
  } catch (const RpcError& error) {
    if (error.code() != kNotAllowedCode) throw;
    throw RpcError(error.code(), error.what() + other_way(values.connection), error.data());
  }
}

}  // namespace

int run_fvdctl(const std::vector<std::string>& arguments, const Terminal& terminal) noexcept {
  try {
    try {
      return run(arguments, terminal);
    } catch (const RpcError& error) {
      std::string message = "the daemon refused: " + std::string(error.what());
      if (!error.data().is_null()) message += " " + error.data().dump();
      return fail(terminal, message + " (code " + std::to_string(error.code()) + ")", exit_code_of_rpc(error.code()));
    } catch (const UsageError& error) {
      return fail(terminal, error.what(), kExitUsage);
    } catch (const Error& error) {
      return fail(terminal, error.what(), exit_code(error.code()));
    } catch (const std::bad_alloc&) {
      return fail(terminal, "not enough memory", kExitInternal);
    } catch (const std::exception& error) {
      return fail(terminal, std::string("unexpected: ") + error.what(), kExitInternal);
    }
  } catch (...) {  // not even the message could be written
    return kExitInternal;
  }
}

}  // namespace fvd::ctl
