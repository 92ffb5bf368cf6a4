#include "daemon/ctl/access_commands.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/base/error.hpp"
#include "daemon/access/token_file.hpp"
#include "daemon/ctl/exit_codes.hpp"

namespace fvd::ctl {

namespace {

/// "2026-11-30T10:00:00.000Z  job.start  ok  plc as operate, address 10.0.0.7, 10.0.0.7:4000  {...}".
std::string line_of(const Json& entry) {
  const auto text = [&entry](const char* key) { return entry.at(key).get<std::string>(); };
  std::string line = text("time_utc") + "  " + text("what") + "  " + text("outcome") + "  " + text("who");
  if (!text("client").empty()) line += ", client " + text("client");
  line += ", " + text("role");
  if (!text("peer").empty()) line += ", " + text("peer");
  return line + "  " + text("detail");
}

int audit(const AccessArguments& arguments, RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("audit.list", {{"most", arguments.most}});
  if (arguments.json) {
    terminal.out << reply.dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
    return kExitOk;
  }
  for (const Json& entry : reply.at("entries")) terminal.out << line_of(entry) << "\n";
  terminal.out << std::flush;
  return kExitOk;
}

constexpr std::chrono::seconds kStandstillTime{5};  ///< an axis halts, and is measured, within less
constexpr std::chrono::milliseconds kLookPeriod{50};
constexpr int kStageLost = 1111;  ///< nobody but the drive itself can tell any more

/// True once the daemon says that the stage stands still; false where it does not in time, or cannot.
bool await_standstill(RpcClient& client) {
  const auto deadline = std::chrono::steady_clock::now() + kStandstillTime;
  do {
    if (client.call("system.health").value("stage", Json::object()).value("standstill", false)) return true;
    if (client.call("system.state").value("error_code", 0) == kStageLost) return false;
    std::this_thread::sleep_for(kLookPeriod);
  } while (std::chrono::steady_clock::now() < deadline);
  return false;
}

int stop(RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("stage.stop");
  terminal.out << "stopped: " << reply.at("stopped").get<std::string>() << std::endl;
  if (reply.value("standstill", false) || await_standstill(client)) return kExitOk;
  throw Error(ErrorCode::kStagePosition,
              "it is NOT confirmed that the stage stands still: look at the axis, and use the emergency stop if it "
              "moves; 'fvdctl state' tells what is wrong");
}

int new_token(const AccessArguments& arguments, const Terminal& terminal) {
  const std::string token = fvd::new_token();
  const Credential credential =
      credential_of(arguments.name, role_from_name(arguments.role).value_or(Role::kView), token);
  terminal.out << token << "\n" << credential.line() << std::endl;
  terminal.err << "fvdctl: the first line is the token, shown this once; the second belongs into the file that "
                  "rpc.token_file names"
               << std::endl;
  return kExitOk;
}

int kiosk_url(const AccessArguments& arguments, const Terminal& terminal) {
  const std::string& page = arguments.page;
  if (!page.starts_with("http://") && !page.starts_with("https://")) {
    throw Error(ErrorCode::kBadInput, "'" + page + "' is no address of a page; expected e.g. http://microscope-3/");
  }
  if (page.find_first_of("# \t\r\n") != std::string::npos) {
    throw Error(ErrorCode::kBadInput, "'" + page + "' must have no fragment and no spaces: the token is the fragment");
  }
  const std::string token = fvd::new_token();
  const Credential credential = credential_of(arguments.name, Role::kOperate, token);
  terminal.out << page << "#token=" << token << "\n" << credential.line() << std::endl;
  terminal.err
      << "fvdctl: the first line is for the kiosk's browser, which never sends what stands behind #; the second "
         "belongs into the file that rpc.token_file names"
      << std::endl;
  return kExitOk;
}

}  // namespace

void log_in(RpcClient& client, const std::filesystem::path& token_file) {
  std::ifstream in(token_file);
  std::string token;
  if (!std::getline(in, token) || token.empty()) {
    throw Error(ErrorCode::kBadInput, "cannot read a token from " + token_file.string());
  }
  while (!token.empty() && (token.back() == '\r' || token.back() == ' ')) token.pop_back();
  client.log_in(token);
}

void add_access_commands(CLI::App& app, AccessArguments& a, const std::function<RpcClient()>& connect,
                         const Terminal& terminal, std::function<int()>& chosen) {
  CLI::App* sub = app.add_subcommand("audit", "print who asked the daemon for what, the newest first");
  sub->add_option("--most", a.most, "so many")->check(CLI::Range(1, 1000))->capture_default_str();
  sub->add_flag("--json", a.json, "print JSON");
  sub->callback(
      [&a, &chosen, connect, terminal] { chosen = [&a, connect, terminal] { return audit(a, connect(), terminal); }; });

  sub = app.add_subcommand("stop", "stop whatever moves the stage, a job too, and see that it stands still");
  sub->callback([&chosen, connect, terminal] { chosen = [connect, terminal] { return stop(connect(), terminal); }; });

  CLI::App* token = app.add_subcommand("token", "make secrets by which callers are recognised");
  token->require_subcommand(1);
  sub = token->add_subcommand("new", "print a new token, and its line for the credential file; asks no daemon");
  sub->add_option("name", a.name, "whose: 1 to 32 letters, digits, '.', '_' and '-'")->required();
  sub->add_option("role", a.role, "what it may")
      ->required()
      ->check(CLI::IsMember({"view", "operate", "set_up", "administer"}));
  sub->callback([&a, &chosen, terminal] { chosen = [&a, terminal] { return new_token(a, terminal); }; });

  sub = app.add_subcommand(
      "kiosk-url",
      "print the address of the operator page for a kiosk that may operate, with its token, and the line of that for "
      "the credential file; asks no daemon");
  sub->add_option("page", a.page, "address of the page, e.g. http://microscope-3/")->required();
  sub->add_option("name", a.name, "of the kiosk")->required();
  sub->callback([&a, &chosen, terminal] { chosen = [&a, terminal] { return kiosk_url(a, terminal); }; });
}

}  // namespace fvd::ctl
