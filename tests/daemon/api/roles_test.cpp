/// Who may call what: every role against every method.

#include <algorithm>
#include <map>
#include <string>

#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/daemon/api/working_params.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using test::working_params;

/// The least role of every method, typed a second time: a method that gets another one by mistake is seen here.
const std::map<std::string, Role>& expected_roles() {
  using enum Role;
  static const std::map<std::string, Role> kRoles{{"alarm.acknowledge", kOperate},
                                                  {"alarm.list", kView},
                                                  {"audit.list", kView},
                                                  {"calibrate.accept", kAdminister},
                                                  {"calibrate.flatness", kAdminister},
                                                  {"calibrate.lateral", kAdminister},
                                                  {"calibrate.noise", kAdminister},
                                                  {"calibrate.texture", kAdminister},
                                                  {"calibrate.z", kAdminister},
                                                  {"calibration.get", kView},
                                                  {"camera.preview", kOperate},
                                                  {"camera.snap", kSetUp},
                                                  {"camera.suggest_exposure", kSetUp},
                                                  {"control.acquire", kOperate},
                                                  {"control.release", kOperate},
                                                  {"control.state", kView},
                                                  {"error.reset", kOperate},
                                                  {"gauge.capability", kSetUp},
                                                  {"gauge.rr", kSetUp},
                                                  {"gauge.type1", kSetUp},
                                                  {"job.abort", kOperate},
                                                  {"job.latest", kView},
                                                  {"job.list", kView},
                                                  {"job.start", kOperate},
                                                  {"job.status", kView},
                                                  {"job.wait", kView},
                                                  {"objective.confirm", kOperate},
                                                  {"objective.list", kView},
                                                  {"recipe.check", kView},
                                                  {"recipe.get", kView},
                                                  {"recipe.list", kView},
                                                  {"recipe.prepare", kOperate},
                                                  {"recipe.restore", kSetUp},
                                                  {"recipe.save", kSetUp},
                                                  {"recipe.versions", kView},
                                                  {"result.ack", kOperate},
                                                  {"result.evaluate", kSetUp},
                                                  {"result.get", kView},
                                                  {"result.next", kView},
                                                  {"result.profile", kView},
                                                  {"rpc.discover", kView},
                                                  {"session.info", kNone},
                                                  {"session.login", kNone},
                                                  {"stage.accuracy", kView},
                                                  {"stage.autofocus", kSetUp},
                                                  {"stage.home", kOperate},
                                                  {"stage.jog", kSetUp},
                                                  {"stage.move", kSetUp},
                                                  {"stage.stop", kOperate},
                                                  {"study.get", kView},
                                                  {"study.list", kView},
                                                  {"system.health", kView},
                                                  {"system.info", kView},
                                                  {"system.ping", kView},
                                                  {"system.state", kView},
                                                  {"value.list", kView},
                                                  {"verify.flatness", kSetUp},
                                                  {"verify.hysteresis", kSetUp},
                                                  {"verify.linearity", kSetUp},
                                                  {"verify.noise", kSetUp},
                                                  {"verify.resolution", kSetUp},
                                                  {"verify.sphere", kSetUp},
                                                  {"verify.step", kSetUp},
                                                  {"verify.texture", kSetUp}};
  return kRoles;
}

class ARole : public ADispatcher, public testing::WithParamInterface<Role> {};

TEST_P(ARole, MayCallWhatItsMethodsSayAndNothingElse) {
  const Role role = GetParam();
  const Caller caller{.who = {"somebody", role}};
  for (const auto& [name, method] : dispatcher_.methods()) {
    const auto expected = expected_roles().find(name);
    ASSERT_NE(expected, expected_roles().end()) << name << " is missing in this test";
    const bool allowed = role >= expected->second;
    const json request{{"jsonrpc", "2.0"}, {"id", 1}, {"method", name}, {"params", working_params(name)}};
    for (const bool at_once : {true, false}) {
      const auto handled = at_once ? dispatcher_.try_handle(request.dump(), caller)
                                   : std::optional(dispatcher_.handle(request.dump(), caller));
      if (at_once && !handled) {
        EXPECT_TRUE(allowed) << name << ": a refusal needs no worker";
        continue;
      }
      // session.login with a wrong token is refused like a method, and tells more.
      if (name == "session.login") continue;
      const bool refused = handled->reply && json::parse(*handled->reply).value("/error/code"_json_pointer, 0) == 1004;
      EXPECT_EQ(refused, !allowed) << name << " for " << role_name(role) << ": " << handled->reply.value_or("waits");
      EXPECT_TRUE(!refused || json::parse(*handled->reply)["error"]["data"]["error"] == "not_allowed") << name;
    }
    const json notification{{"jsonrpc", "2.0"}, {"method", name}, {"params", working_params(name)}};
    if (!allowed) (void)dispatcher_.handle("[" + notification.dump() + "]", caller);
  }
  EXPECT_EQ(expected_roles().size(), dispatcher_.methods().size()) << "this test has a method too many";
  // What a refused caller asked for has left no trace.
  if (role < Role::kOperate) {
    EXPECT_EQ(service_.starts + service_.stops + service_.aborts, 0);
    EXPECT_EQ(service_.task, nullptr);
    EXPECT_FALSE(service_.objectives.confirmed);
    EXPECT_FALSE(service_.control.holder());
    EXPECT_FALSE(service_.alarms.newest().front().acknowledged);
  }
  if (role < Role::kSetUp) {
    EXPECT_TRUE(service_.jogs.empty());
    EXPECT_TRUE(service_.recipes.saved.id.empty());
    EXPECT_EQ(service_.recipes.restored, -1);
    EXPECT_FALSE(service_.studies.begun);
    EXPECT_LE(std::count(service_.motions.begin(), service_.motions.end(), TaskMotion::kMoves), 1) << "homing alone";
  }
  if (role < Role::kAdminister) {
    EXPECT_FALSE(service_.studies.accepted);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, ARole,
                         testing::Values(Role::kNone, Role::kView, Role::kOperate, Role::kSetUp, Role::kAdminister),
                         [](const auto& of) { return std::string(role_name(of.param)); });

TEST_F(ADispatcher, ClosesAMethodThatNamesNoRoleToAllButWhoAdministers) {
  MethodTable methods = all_methods(service_.services());
  methods["new.method"] = {.about = {.summary = "", .params = described<NoParams>(), .result = described<NoParams>()},
                           .peek = [](const Call&) { return Reply::object(); }};
  const Dispatcher dispatcher(std::move(methods), service_.services());
  const std::string call = R"({"jsonrpc":"2.0","id":1,"method":"new.method"})";
  const auto refused = dispatcher.handle(call, {.who = {"somebody", Role::kSetUp}});
  EXPECT_EQ(json::parse(refused.reply.value())["error"]["code"], 1004);
  EXPECT_TRUE(json::parse(dispatcher.handle(call, caller_).reply.value()).contains("result"));
}

}  // namespace
}  // namespace fvd
