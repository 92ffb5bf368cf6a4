/// fvd: reads its configuration, starts, and waits for the signal to stop.

#include <cstdlib>
#include <exception>
#include <iostream>

#include <malloc.h>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/base/exit_code.hpp"
#include "daemon/devices/left_threads.hpp"
#include "daemon/options.hpp"
#include "daemon/service.hpp"

namespace {

/// Each job's threads are new ones. With the standard eight heaps a core they come upon another one each time, and
/// years of jobs leave in each of them the most that any thread ever needed.
void keep_heaps_few() { (void)::mallopt(M_ARENA_MAX, 2); }

}  // namespace

int main(int argc, char** argv) try {
  using namespace fvd;
  keep_heaps_few();
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
