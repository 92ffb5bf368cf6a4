#pragma once

/// Threads that the end of the process does not wait for: opening or closing a device that answers nothing takes many
/// seconds, and nobody can stop it.

#include <functional>
#include <string>
#include <thread>

namespace fvd {

/// The process ends: from now on nothing waits for such threads longer than a fifth of a second. What they hold is left
/// to the system, which closes their sockets. context: thread-safe, as all of these.
void process_ends() noexcept;
[[nodiscard]] bool process_is_ending() noexcept;

/// Keeps a thread that still runs, until the process is gone.
void leave_thread(std::jthread thread);
/// A thread was left: the process must end by std::_Exit().
[[nodiscard]] bool left_a_thread() noexcept;

/// Runs the work on a thread of this name and waits for it; an exception of the work is the caller's. False if the
/// process ends before the work does: the thread is left, so that it must own all that it uses.
[[nodiscard]] bool run_unless_process_ends(std::string name, std::function<void()> work);

}  // namespace fvd
