/// Lines of JSON-RPC to a dispatcher on a job service without devices; several, so that jobs can be asked for.

#include <optional>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "config/strict_json.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/api/methods/methods.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

namespace {

constexpr int kInternalError = -32603;

/// One object with a result or an error, which is never an internal one: whoever sends a line can know what was wrong.
void check_member(const nlohmann::json& reply) {
  require(reply.is_object() && reply.value("jsonrpc", "") == "2.0" && reply.contains("id"));
  require(reply.contains("result") != reply.contains("error"));
  if (!reply.contains("error")) return;
  const nlohmann::json& error = reply["error"];
  require(error["code"].is_number_integer() && error["code"] != kInternalError && !error["message"].empty());
}

void check_reply(const std::string& line) {
  for (const char c : line) require(c >= ' ' && c <= '~');
  Problems problems;
  const auto reply = parse_strict_json(line, problems, JsonComments::kRefused);
  require(reply.has_value());
  if (!reply->is_array()) return check_member(*reply);
  require(!reply->empty());
  for (const nlohmann::json& member : *reply) check_member(member);
}

void handle(const Dispatcher& dispatcher, std::string_view line, Caller& caller) {
  // What may pass others is a single request, and no log-in passes as one that reads much.
  if (const Method* const method = dispatcher.overtaker(line))
    (void)Dispatcher::may_overtake(*method, caller, Dispatcher::Behind::kWait);
  require(!(dispatcher.is_log_in(line) && dispatcher.is_long(line)));
  auto handled = dispatcher.try_handle(line, caller);
  if (!handled) handled = dispatcher.handle(line, caller);
  if (handled->reply) check_reply(*handled->reply);
  if (handled->log_in) caller.who = *handled->log_in;
  if (!handled->waiting) return;
  require(!handled->reply);
  (void)dispatcher.may_have_come(*handled->waiting);
  if (const auto reply = dispatcher.resume(*handled->waiting, false)) check_reply(*reply);
  const auto late = dispatcher.resume(*handled->waiting, true);
  require(late.has_value());
  check_reply(*late);
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  spdlog::set_level(spdlog::level::off);
  // Made anew for every input, in its place: making the methods, which name it, takes far longer than most inputs do.
  static std::optional<FakeJobService> service;
  service.emplace();
  const Services services = service->services();
  static const Dispatcher dispatcher(all_methods(services), services);
  Caller caller{.who = {"fuzz", Role::kAdminister}};
  for (const std::string_view line : test::parts_of(test::text_of({bytes, size}), '\n')) {
    if (line.size() <= Dispatcher::kMaxLineBytes) test::handle(dispatcher, line, caller);
  }
  return 0;
}
