#pragma once

/// The only way to start a thread: with a name, and with a handler for an exception that leaves it.

#include <exception>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace fvd {

/// Called on a thread that ends by an exception, before it ends. Must not throw.
using ThreadFailure = std::function<void(std::string_view name, std::exception_ptr failure)>;

/// Starts `body` on a thread called `name` (the system shows at most 15 characters). An exception that leaves the body
/// is passed to on_failure; without one, to the handler of the process. context: thread-safe.
[[nodiscard]] std::jthread start_thread(std::string name, std::function<void(std::stop_token)> body,
                                        ThreadFailure on_failure = {});

/// Sets the handler of the process, which logs the failure and ends the program in order. To be called before the first
/// thread starts. Without a handler the exception is written to standard error and the program aborts.
void set_thread_failure_handler(ThreadFailure handler);

}  // namespace fvd
