#include "daemon/ctl/setup_command.hpp"

#include <cerrno>
#include <optional>
#include <stop_token>

#include <CLI/CLI.hpp>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/stop_on_signal.hpp"
#include "daemon/setup/setup.hpp"
#include "drivers/aravis/usb_cameras.hpp"
#include "drivers/gige/camera_discovery.hpp"

namespace fvd::ctl {

namespace {

constexpr std::size_t kLongestAnswer_bytes = 4096;
/// How often a wait for an answer looks for Ctrl-C.
constexpr int kStopPoll_ms = 100;

/// The next line without its end; nothing at the end of the answers. Throws Error kAborted after a stop request.
std::optional<std::string> next_answer(int fd, const std::stop_token& stop) {
  std::string line;
  while (line.size() < kLongestAnswer_bytes) {
    if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the setup was stopped; nothing was written");
    pollfd readable{fd, POLLIN, 0};
    if (::poll(&readable, 1, kStopPoll_ms) <= 0) continue;
    char byte = 0;
    const ssize_t count = ::read(fd, &byte, 1);  // not more: what follows may be for somebody else
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return line.empty() ? std::nullopt : std::optional(line);
    if (byte == '\n') return line;
    line += byte;
  }
  throw Error(ErrorCode::kBadInput, "an answer of more than 4096 bytes; nothing was written");
}

void show(const SetupQuestion& question, std::ostream& out) {
  if (!question.note.empty()) out << "  -> " << question.note << "\n";
  out << "\n[" << question.step << "] " << question.text << "\n";
  if (!question.picture.empty()) out << "    picture: " << question.picture.string() << "\n";
  for (const SetupChoice& choice : question.choices) {
    out << "    " << choice.word << "  " << choice.meaning << (choice.moves ? "  (MOVES the axis)" : "") << "\n";
  }
  out << "> " << std::flush;
}

std::vector<FoundCamera> find_cameras(const SetupArguments& arguments) {
  std::vector<FoundCamera> cameras;
  std::vector<NetworkInterface> interfaces;
  if (arguments.interfaces.empty()) interfaces = network_interfaces();
  for (const std::string& name : arguments.interfaces) {
    for (NetworkInterface& one : network_interfaces(name)) interfaces.push_back(std::move(one));
  }
  cameras = discover_cameras(interfaces);
  for (FoundCamera& camera : list_usb_cameras().value_or(std::vector<FoundCamera>{})) {
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

int run_setup(const SetupArguments& arguments, const Terminal& terminal) {
  if (terminal.in_fd < 0) throw UsageError("setup needs answers on its input");
  SetupOptions options{arguments.out, arguments.drives, arguments.pictures, arguments.simulated, {}};
  if (!arguments.no_search) options.find_cameras = [&arguments] { return find_cameras(arguments); };
  const StopOnSignal signal;
  if (!arguments.json) {
    terminal.out
        << "Every answer can be taken back by 'back'. The axis moves on an answer that says so, and on no other;"
           " Ctrl-C halts it."
        << std::endl;
  }
  Setup setup(std::move(options), signal.token());
  const bool script = ::isatty(terminal.in_fd) == 0 && !arguments.json;  // a program reads that it was refused
  while (!setup.done()) {
    // What was typed before a question was seen is no answer to it: the axis might move on it.
    if (::isatty(terminal.in_fd) != 0) ::tcflush(terminal.in_fd, TCIFLUSH);
    if (arguments.json) {
      terminal.out << to_json(setup.question()).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
                   << std::endl;
    } else {
      show(setup.question(), terminal.out);
    }
    const auto answer = next_answer(terminal.in_fd, signal.token());
    if (!answer) {
      throw Error(ErrorCode::kBadInput, "the answers end at the question '" + setup.question().step +
                                            "'; the setup is not finished, and nothing was written");
    }
    const std::string step = setup.question().step;
    setup.answer(*answer);
    if (script && setup.refused()) {  // the answers that follow are to other questions
      throw Error(ErrorCode::kBadInput, "the answer '" + *answer + "' to the question '" + step +
                                            "' was refused: " + setup.question().note +
                                            "; the setup is not finished, and nothing was written");
    }
  }
  if (arguments.json) {
    terminal.out << nlohmann::ordered_json{{"written", setup.written().string()}, {"note", setup.report()}}.dump()
                 << std::endl;
  } else {
    terminal.out << "  -> " << setup.report() << std::endl;
  }
  return kExitOk;
}

}  // namespace

void add_setup_command(CLI::App& app, SetupArguments& a, const Terminal& terminal, std::function<int()>& chosen) {
  CLI::App* sub = app.add_subcommand(
      "setup", "set a station up by questions and answers, without the daemon; MOVES the axis on answers that say so");
  sub->add_option("--out", a.out, "configuration that is to be written; one that is there is kept")
      ->capture_default_str();
  sub->add_option("--drives", a.drives, "folder of drive profiles")->capture_default_str();
  sub->add_option("--pictures", a.pictures, "folder for the camera's picture, setup.png")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  CLI::Option* interface =
      sub->add_option("--interface", a.interfaces, "look for cameras through this network interface or address only");
  interface->allow_extra_args(false);
  sub->add_flag("--no-search", a.no_search, "look for no cameras; the address is known")->excludes(interface);
  sub->add_flag("--simulated", a.simulated, "say in the configuration that camera and stage are simulated");
  sub->add_flag("--json", a.json, "print each question as a line of JSON, for programs that answer");
  sub->callback([&] { chosen = [&] { return run_setup(a, terminal); }; });
}

}  // namespace fvd::ctl
