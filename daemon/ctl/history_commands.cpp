#include "daemon/ctl/history_commands.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "daemon/ctl/exit_codes.hpp"

namespace fvd::ctl {

namespace {

constexpr int kMostAtOnce = 500;  ///< that the daemon tells in one answer

Json filter_of(const JobsArguments& a) {
  Json filter = Json::object();
  const auto add = [&filter](const char* key, const std::string& value) {
    if (!value.empty()) filter[key] = value;
  };
  add("part_id", a.part);
  add("recipe", a.recipe);
  add("verdict", a.verdict);
  add("state", a.state);
  add("from_utc", a.from_utc);
  add("to_utc", a.to_utc);
  add("text", a.text);
  return filter;
}

/// The newest jobs, asked for part by part.
Json jobs_of(const JobsArguments& a, RpcClient& client) {
  Json jobs = Json::array();
  Json params = filter_of(a);
  do {
    params["most"] = std::min(kMostAtOnce, a.most - static_cast<int>(jobs.size()));
    const Json part = client.call("job.list", params);
    for (const Json& job : part.at("jobs")) jobs.push_back(job);
    params["before"] = part.at("next");
  } while (params["before"] != "" && static_cast<int>(jobs.size()) < a.most);
  return jobs;
}

/// "2026-11-30T10:00:05.250Z  completed  pass  P-0815  groove  20261130T100000Z-00003-000042".
std::string line_of(const Json& job) {
  const auto text = [&job](const char* key) { return job.at(key).get<std::string>(); };
  const std::string ended = text("ended_utc");
  const std::string verdict = job.at("verdict").is_string() ? text("verdict") : "-";
  const std::string error = text("error");
  return (ended.empty() ? "-" : ended) + "  " + text("state") + (error.empty() ? "" : " (" + error + ")") + "  " +
         verdict + "  " + text("part_id") + "  " + text("recipe") + "  " + text("job_id");
}

int jobs(const JobsArguments& arguments, RpcClient client, const Terminal& terminal) {
  const Json found = jobs_of(arguments, client);
  if (arguments.json) {
    terminal.out << found.dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
    return kExitOk;
  }
  for (const Json& job : found) terminal.out << line_of(job) << "\n";
  terminal.out << std::flush;
  // Beside the list, which whoever counts its lines takes for jobs.
  if (found.empty()) terminal.err << (filter_of(arguments).empty() ? "no jobs" : "no such job") << std::endl;
  return kExitOk;
}

}  // namespace

void add_history_commands(CLI::App& app, JobsArguments& a, const std::function<RpcClient()>& connect,
                          const Terminal& terminal, std::function<int()>& chosen) {
  CLI::App* sub = app.add_subcommand("jobs", "print jobs, the newest first");
  sub->add_option("--most", a.most, "so many")->check(CLI::Range(1, 100000))->capture_default_str();
  sub->add_option("--part", a.part, "only of parts whose id begins so");
  sub->add_option("--recipe", a.recipe, "only of this recipe, by its id");
  sub->add_option("--verdict", a.verdict, "only with this verdict on the part; none: nothing was judged")
      ->check(CLI::IsMember({"pass", "fail", "uncertain", "invalid", "none"}));
  sub->add_option("--state", a.state, "only in this state")
      ->check(CLI::IsMember({"processing", "completed", "aborted", "failed"}));
  sub->add_option("--from", a.from_utc, "only those that ended then or later, as 2026-11-30T10:00:00Z");
  sub->add_option("--to", a.to_utc, "only those that ended then or before");
  sub->add_option("--text", a.text, "only those that have this in id, part, recipe, client, state or error");
  sub->add_flag("--json", a.json, "print JSON");
  sub->callback(
      [&a, &chosen, connect, terminal] { chosen = [&a, connect, terminal] { return jobs(a, connect(), terminal); }; });
}

}  // namespace fvd::ctl
