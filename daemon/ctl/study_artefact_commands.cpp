#include "daemon/ctl/study_artefact_commands.hpp"

#include <CLI/CLI.hpp>

#include "daemon/ctl/process_command.hpp"

namespace fvd::ctl {

namespace {

/// So many jobs as the study takes. Throws UsageError.
std::vector<std::string> jobs_of(const Desk& desk, std::size_t least, std::size_t most, const char* which) {
  std::vector<std::string> jobs = ctl::jobs_of(desk);
  if (jobs.size() < least || jobs.size() > most) throw UsageError(std::string("give ") + which);
  return jobs;
}

int run_lateral(const Desk& desk) {
  const auto jobs = jobs_of(desk, 1, 2, "one job of a cross grid, and for the drift a second of it at another height");
  Json params{{"job", jobs[0]}};
  if (jobs.size() > 1) params["second_job"] = jobs[1];
  put(params, "grid_pitch_um", desk.a.grid_pitch_um);
  put(params, "u_grid_relative", desk.a.u_grid_relative);
  put_region(desk.a, params);
  return finish(desk, "calibrate.lateral", params);
}

int run_resolution(const Desk& desk) {
  Json params{{"job", jobs_of(desk, 1, 1, "one job of a star or an edge")[0]}, {"artefact", desk.a.artefact}};
  put(params, "height_um", desk.a.height_um);
  put(params, "pairs", desk.a.pairs);
  put_region(desk.a, params);
  return finish(desk, "verify.resolution", params);
}

int run_sphere(const Desk& desk) {
  Json params{{"job", jobs_of(desk, 1, 1, "one job of a sphere's cap")[0]}};
  put(params, "radius_um", desk.a.radius_um);
  put(params, "u_radius_um", desk.a.u_radius_um);
  if (desk.a.bowl) params["bowl"] = true;
  put_region(desk.a, params);
  return finish(desk, "verify.sphere", params);
}

int run_hysteresis(const Desk& desk) {
  const auto jobs = jobs_of(desk, 2, 2, "two jobs: the one scanned upwards, then the one scanned downwards");
  Json params{{"up", jobs[0]}, {"down", jobs[1]}};
  put_region(desk.a, params);
  return finish(desk, "verify.hysteresis", params);
}

int run_texture(const Desk& desk, const std::string& method) {
  Json params{{"jobs", ctl::jobs_of(desk)}, {"measurement", desk.a.measurement}};
  put(params, "value", desk.a.value);
  put_evaluated(desk.a, params);
  return finish(desk, method, params);
}

void add_texture_command(CLI::App& parent, const Desk& desk, const std::string& method, const char* help) {
  CLI::App* sub = add_asked(parent, desk, "texture", help, [desk, method] { return run_texture(desk, method); });
  add_job_options(*sub, desk.a);
  add_value_options(*sub, desk.a);
}

}  // namespace

void add_verifying_artefacts(CLI::App& verify, const Desk& desk) {
  CLI::App* sub = add_asked(verify, desk, "resolution", "lateral resolution W_R and D_LIM, from a star or an edge",
                            [desk] { return run_resolution(desk); });
  add_job_options(*sub, desk.a);
  sub->add_option("--artefact", desk.a.artefact, "star or edge")->required()->check(CLI::IsMember({"star", "edge"}));
  sub->add_option("--height-um", desk.a.height_um, "true height of a star's raised sectors");
  sub->add_option("--pairs", desk.a.pairs, "of a star's sectors; default: found");
  add_region_options(*sub, desk.a);
  sub = add_asked(verify, desk, "sphere", "probing errors P_F and P_S and the slope limit, from a sphere's cap",
                  [desk] { return run_sphere(desk); });
  add_job_options(*sub, desk.a);
  sub->add_option("--radius-um", desk.a.radius_um, "of the sphere, by the certificate")->required();
  sub->add_option("--u-radius-um", desk.a.u_radius_um, "standard uncertainty of that radius");
  sub->add_flag("--bowl", desk.a.bowl, "the surface is the inner side");
  add_region_options(*sub, desk.a);
  sub = add_asked(verify, desk, "hysteresis", "what a scan downwards (second job) sees otherwise than one upwards",
                  [desk] { return run_hysteresis(desk); });
  add_job_options(*sub, desk.a);
  add_region_options(*sub, desk.a);
  add_texture_command(verify, desk, "verify.texture", "reproducibility of a texture value, of one surface placed anew");
}

void add_calibrating_artefacts(CLI::App& calibrate, const Desk& desk) {
  CLI::App* sub = add_asked(calibrate, desk, "lateral",
                            "propose pitch and shear, from a cross grid; a second job at another height adds the drift",
                            [desk] { return run_lateral(desk); });
  add_job_options(*sub, desk.a);
  sub->add_option("--grid-pitch-um", desk.a.grid_pitch_um, "of the grid's lines, by the certificate")->required();
  sub->add_option("--u-grid-relative", desk.a.u_grid_relative, "standard uncertainty of that pitch, over the pitch");
  add_region_options(*sub, desk.a);
  add_texture_command(calibrate, desk, "calibrate.texture", "propose the reproducibility of texture values");
}

}  // namespace fvd::ctl
