#include <iostream>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/ctl/fvdctl.hpp"

int main(int argc, char** argv) {
  // Standard output is for answers alone, which programs read.
  spdlog::set_default_logger(spdlog::stderr_color_mt("fvdctl"));
  spdlog::set_pattern("fvdctl: %^%l%$: %v");
  spdlog::set_level(spdlog::level::warn);
  const fvd::ctl::Terminal terminal{std::cout, std::cerr, isatty(STDOUT_FILENO) == 1, isatty(STDERR_FILENO) == 1,
                                    STDIN_FILENO};
  return fvd::ctl::run_fvdctl({argv + 1, argv + argc}, terminal);
}
