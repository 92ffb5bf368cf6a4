#include "daemon/ctl/study_scans.hpp"

#include <iostream>
#include <sstream>

#include <unistd.h>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/job_commands.hpp"
#include "daemon/ctl/process_command.hpp"

namespace fvd::ctl {

std::string scan_once(RpcClient& client, const ScanOrder& order) {
  StartOptions options;
  options.part_id = order.part;
  options.recipe = order.recipe;
  const std::string id = start_job(client, options, order.owner).value("job_id", "");
  const Json status = wait_for_job(client, {{"job_id", id}});
  if (job_exit_code(status) == kExitOk) return id;
  throw Error(ErrorCode::kJobFailed, "job " + id + " " + status.value("state", "") + ": " +
                                         (status.contains("error_message") && status["error_message"].is_string()
                                              ? status["error_message"].get<std::string>()
                                              : std::string("unknown")));
}

std::vector<std::string> scan_often(RpcClient& client, const ScanOrder& order, int scans, const Terminal& terminal) {
  terminal.err << "fvdctl: the stage MOVES: " << scans << " scans of " << order.part << std::endl;
  std::vector<std::string> jobs;
  for (int i = 0; i < scans; ++i) {
    jobs.push_back(scan_once(client, order));
    terminal.err << "fvdctl: scan " << i + 1 << " of " << scans << ": " << jobs.back() << std::endl;
  }
  return jobs;
}

std::vector<std::string> scan_crossed(RpcClient& client, const ScanOrder& order, int parts, int operators, int trials,
                                      const Terminal& terminal) {
  if (!terminal.err_is_terminal || ::isatty(STDIN_FILENO) == 0) {
    throw UsageError("gauge rr asks for each part and operator, which needs a terminal; give --jobs-file");
  }
  std::vector<std::string> jobs;
  for (int part = 1; part <= parts; ++part) {
    for (int who = 1; who <= operators; ++who) {
      for (int trial = 1; trial <= trials; ++trial) {
        terminal.err << "part " << part << ", operator " << who << ", trial " << trial
                     << ": put the part in place and press Enter; the stage MOVES then " << std::flush;
        std::string line;
        if (!std::getline(std::cin, line)) throw UsageError("the input ended before the last scan");
        ScanOrder next = order;
        next.part = (order.part.empty() ? std::string("part") : order.part) + "-" + std::to_string(part);
        jobs.push_back(scan_once(client, next));
      }
    }
  }
  return jobs;
}

std::vector<std::string> read_jobs_file(const std::string& file) {
  std::istringstream lines(read_text_file(file));
  std::vector<std::string> jobs;
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.pop_back();
    if (!line.empty() && line.front() != '#') jobs.push_back(line);
  }
  return jobs;
}

}  // namespace fvd::ctl
