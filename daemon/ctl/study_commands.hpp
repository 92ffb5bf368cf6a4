#pragma once

/// The commands `fvdctl verify|calibrate|gauge|study|calibration`.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"
#include "daemon/ctl/rpc_client.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

/// The arguments as typed.
struct StudyArguments {
  std::vector<std::string> jobs;
  std::string jobs_file;             ///< a job id a line
  std::vector<std::string> folders;  ///< of results, in place of jobs: without a daemon
  bool offline = false;              ///< the jobs of steps are such folders
  std::string calibration;           ///< folder of calibration.json, for reference maps; without a daemon
  int scans = 0;                     ///< jobs to start for the study; 0 = none
  std::string scan_recipe;
  std::string part;
  std::vector<double> region_um;  ///< x, y, width, height
  std::vector<double> circle_um;  ///< x, y, radius
  std::optional<double> grid_pitch_um;
  std::optional<double> u_grid_relative;
  std::string artefact;
  std::optional<double> height_um;
  std::optional<int> pairs;
  std::optional<double> radius_um;
  std::optional<double> u_radius_um;
  bool bowl = false;
  std::optional<double> s_nesting_um;
  std::vector<std::string> steps;  ///< "JOB=REFERENCE,U" or "JOB=Z"
  std::optional<double> u_common_relative;
  std::string measurement = "step";
  std::optional<std::string> value;
  std::string evaluate_by;
  bool require_calibration = false;
  std::optional<double> reference;
  std::optional<double> tolerance;
  std::optional<double> resolution;
  std::optional<double> required;
  int parts = 0;
  int operators = 0;
  int trials = 0;
  std::string type1;
  std::string rr;
  std::optional<double> u_calibration;
  std::string study;
  std::string person;
  std::string certificate;
  std::string renew_by;
  std::string kind;
  std::string version;
  std::string objective;
  bool json = false;
};

/// connect: called by those that need the daemon. chosen: set to the command that the line names.
void add_study_commands(CLI::App& app, StudyArguments& arguments, const std::function<RpcClient()>& connect,
                        const std::string& client, const Terminal& terminal, std::function<int()>& chosen);

}  // namespace fvd::ctl
