/// fvd: reads its configuration, starts, and waits for the signal to stop.

#include <cstdlib>
#include <exception>
#include <iostream>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/base/exit_code.hpp"
#include "daemon/base/heap.hpp"
#include "daemon/devices/left_threads.hpp"
#include "daemon/options.hpp"
#include "daemon/service.hpp"

int main(int argc, char** argv) try {
  using namespace fvd;
  bound_heap();
  const ParsedOptions parsed = parse_options(argc, argv, std::cout, std::cerr);
  if (parsed.exit) return *parsed.exit;
  const StartUp start = start_up(parsed.options, std::cout, std::cerr);
  if (start.exit) return *start.exit;
  try {
    const int code = serve(parsed.options, start.config);
    if (!left_a_thread()) return code;
    spdlog::warn("a device that answers nothing is not closed in order; the system closes its connection");
    spdlog::default_logger()->flush();  // not gone: the thread that was left may log
    std::_Exit(code);
  } catch (const Error& error) {
    spdlog::critical("{}: {}", error_name(error.code()), error.what());
    return exit_code_of(error.code());
  }
} catch (const std::exception& error) {
  std::cerr << "fvd: " << error.what() << '\n';
  return fvd::exit_code::kInternal;
}
