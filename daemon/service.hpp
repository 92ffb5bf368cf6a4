#pragma once

/// The program between its start and the signal that ends it.

#include "daemon/options.hpp"

namespace fvd {

/// Serves until SIGTERM or SIGINT, or until a thread ends by an exception; SIGHUP reads the configuration again
/// (plan_reload()). A port that cannot be had is waited for where a service manager started the program, for a minute.
/// The exit code. Throws Error as App does. context: the main thread, before any other exists.
[[nodiscard]] int serve(const Options& options, Config config);

}  // namespace fvd
