#include "daemon/ctl/objective_commands.hpp"

#include <cstdlib>
#include <sstream>
#include <utility>

#include <CLI/CLI.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/job_commands.hpp"

namespace fvd::ctl {

namespace {

/// "20x  NA 0.4, 20x, 11 mm, z -100..50 um  confirmed".
std::string line_of(const Json& objective, const std::string& confirmed) {
  std::ostringstream text;
  text << objective.at("name").get<std::string>() << "  NA " << objective.at("na").get<double>() << ", "
       << objective.at("magnification").get<double>() << "x, " << objective.at("working_distance_mm").get<double>()
       << " mm";
  if (objective.contains("min_um")) text << ", z from " << objective["min_um"].get<double>() << " um";
  if (objective.contains("max_um")) text << ", z up to " << objective["max_um"].get<double>() << " um";
  if (objective.at("name") == confirmed) text << "  confirmed";
  return text.str();
}

int list(RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("objective.list");
  const std::string confirmed = reply.at("objective").get<std::string>();
  for (const Json& objective : reply.at("objectives")) terminal.out << line_of(objective, confirmed) << "\n";
  terminal.out << std::flush;
  if (reply.at("objectives").empty()) {
    terminal.err << "fvdctl: the configuration names no objectives" << std::endl;
  } else if (confirmed.empty()) {
    terminal.err << "fvdctl: none is confirmed; 'fvdctl objective confirm NAME' says which one is on the microscope"
                 << std::endl;
  } else {
    terminal.err << "fvdctl: confirmed by " << reply.at("person").get<std::string>() << ", "
                 << reply.at("confirmed_utc").get<std::string>() << std::endl;
  }
  return kExitOk;
}

std::string person_of(const ObjectiveArguments& arguments) {
  if (!arguments.person.empty()) return arguments.person;
  const char* user = std::getenv("USER");
  return user != nullptr && *user != '\0' ? user : kClientName;
}

int confirm(const ObjectiveArguments& arguments, RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("objective.confirm", {{"name", arguments.name}, {"person", person_of(arguments)}});
  terminal.out << reply.at("objective").get<std::string>() << " confirmed by " << reply.at("person").get<std::string>()
               << std::endl;
  return kExitOk;
}

}  // namespace

void add_objective_commands(CLI::App& app, ObjectiveArguments& a, const std::function<RpcClient()>& connect,
                            const Terminal& terminal, std::function<int()>& chosen) {
  CLI::App* objective = app.add_subcommand("objective", "see the objectives, say which one is on the microscope");
  objective->require_subcommand(1);
  objective->add_subcommand("list", "print the objectives of the configuration and which one is confirmed")
      ->callback([&chosen, connect, terminal] { chosen = [connect, terminal] { return list(connect(), terminal); }; });
  CLI::App* sub = objective->add_subcommand(
      "confirm", "say that this objective is on the microscope; recipes that name another are refused");
  sub->add_option("name", a.name, "as `list` prints it")->required();
  sub->add_option("--person", a.person, "who looked; default: the name of the user");
  sub->callback([&a, &chosen, connect, terminal] {
    chosen = [&a, connect, terminal] { return confirm(a, connect(), terminal); };
  });
}

}  // namespace fvd::ctl
