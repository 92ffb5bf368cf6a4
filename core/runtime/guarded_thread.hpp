#pragma once

/// The one way to start a thread: with a name, and with somebody to tell if it ends by an exception.

#include <exception>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace fvd {

/// Called on a thread that ends by an exception, before it ends. Must not throw.
using ThreadFailure = std::function<void(std::string_view name, std::exception_ptr failure)>;

/// Starts body on a thread called `name` (at most 15 characters are shown by the system). An exception that leaves the
/// body goes to on_failure; without one, to the process' handler.
[[nodiscard]] std::jthread start_thread(std::string name, std::function<void(std::stop_token)> body,
                                        ThreadFailure on_failure = {});

/// Sets the process' handler, which a program does before it starts threads: it logs and ends the program in order.
/// Without one a thread's exception is written to standard error and the program aborts.
void set_thread_failure_handler(ThreadFailure handler);

}  // namespace fvd
