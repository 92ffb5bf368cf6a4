/// What the camera driver does on a simulated camera: faults, loss, restarts, the wrap of block ids, throughput, slices
/// per second, and a scan in one motion against the same slices step by step. Prints a table; the last line is one JSON
/// object. With the argument
/// "devices" the faults and the names of cameras alone. With "soak" it lets a camera run free at 2048 x 2048 over a
/// gigabit line for ten minutes instead.

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "tests/bench/camera_benches.hpp"

namespace fvd::test {
namespace {

int run() {
  const FaultFigures faults = run_faults();
  const double killed_ms = recover_after_kill();
  const int loss5 = right_slices(0.05, 1, 100);
  const int restarts = right_slices(0.0, 5, 20);
  const int wrap_lost = lost_over_the_wrap(70000);
  const double server = server_frames_per_s();
  const Throughput open = run_free(0.0, server, 4.0, true);
  const Throughput gigabit = run_free(1000.0, 28.0, 10.0, false);
  const double per_s = slices_per_s();
  double without = 1e9;
  double with = 1e9;
  for (int i = 0; i < 3; ++i) {
    without = std::min(without, step_scan_s(false));
    with = std::min(with, step_scan_s(true));
  }
  print_position_error();
  const Motion motion = run_motion();
  const nlohmann::ordered_json figures{
      {"fault_cases", faults.cases},
      {"wrong_slices_accepted", faults.wrong},
      {"accounting_violations", faults.violations},
      {"loss5_ok_of_100", loss5},
      {"restarts_ok_of_100", restarts},
      {"id_wrap_lost", wrap_lost},
      {"throughput_over_server", open.frames_per_s / server},
      {"receive_core_percent_at_118mb", gigabit.core_percent},
      {"slices_per_s_5ms", per_s},
      {"overlap_ratio", with / without},
      {"continuous_speedup", motion.speedup},
      {"continuous_error_ratio", motion.error_ratio},
      {"recover_ms_after_restart", std::max(killed_ms, faults.recover_ms)},
      {"hang_detect_ms", faults.hang_ms},
  };
  std::cout << figures.dump() << std::endl;
  return 0;
}

int devices() {
  const FaultFigures faults = run_faults();
  const nlohmann::ordered_json figures{
      {"camera_found_by", camera_found_by()},
      {"wrong_camera_used", wrong_camera_used()},
      {"fault_cases_camera", faults.as_expected},
      {"wrong_slices_accepted", faults.wrong},
  };
  std::cout << figures.dump() << std::endl;
  return 0;
}

int soak() {
  const Throughput result = run_free(1000.0, 28.0, 600.0, false);
  std::cout << nlohmann::json{{"soak_s", result.duration_s},
                              {"soak_frames_per_s", result.frames_per_s},
                              {"soak_lost", result.lost},
                              {"soak_receive_core_percent", result.core_percent}}
                   .dump()
            << std::endl;
  return result.lost == 0 ? 0 : 1;
}

}  // namespace
}  // namespace fvd::test

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  spdlog::set_level(spdlog::level::err);
  const std::string part = argc > 1 ? argv[1] : "";
  if (part == "soak") return fvd::test::soak();
  if (part == "devices") return fvd::test::devices();
  if (part == "motion") {
    fvd::test::print_position_error();
    const auto motion = fvd::test::run_motion();
    std::printf("speedup %.2f, error ratio %.3f\n", motion.speedup, motion.error_ratio);
    return 0;
  }
  if (part == "throughput") {
    const double server = fvd::test::server_frames_per_s();
    for (const double share : {1.0, 0.9, 0.8}) (void)fvd::test::run_free(0.0, share * server, 4.0, true);
    (void)fvd::test::run_free(0.0, 0.9 * server, 4.0, false);
    return 0;
  }
  return fvd::test::run();
}
