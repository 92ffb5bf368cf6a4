/// The documents are those of the API, and what counts as a change of them.

#include "daemon/events/topic_documents.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>

#include "daemon/api/dispatcher.hpp"
#include "daemon/api/methods/methods.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/support/rpc_text.hpp"

namespace fvd {
namespace {

using nlohmann::json;

class TopicDocumentsTest : public ::testing::Test {
 protected:
  TopicDocumentsTest() {
    machine_.state = ScanState::kReady;
    machine_.epoch = 17;
    JobStatus job;
    job.job_id = "job-1";
    job.request.seq = 1;
    job.request.part_id = "<script>";
    job.slices_planned = 21;
    machine_.job = job;
    service_.machine = machine_;
  }
  /// The keys that a method's result has.
  std::set<std::string> keys_of(const std::string& method, const json& params = json::object()) {
    const Dispatcher dispatcher(all_methods(services_), services_);
    Caller caller;
    caller.who = {"test", Role::kView};
    const auto handled = dispatcher.handle(test::call(method, params), caller);
    return keys(json::parse(*handled.reply)["result"]);
  }
  static std::set<std::string> keys(const json& object) {
    std::set<std::string> names;
    for (const auto& [name, value] : object.items()) names.insert(name);
    return names;
  }
  static json parsed(const TopicDocument& document) { return json::parse(document.text); }

  FakeJobService service_;
  const Services services_ = service_.services();
  MachineStatus machine_;
};

TEST_F(TopicDocumentsTest, AreThoseOfTheMethods) {
  const TopicDocuments documents(services_);
  EXPECT_EQ(keys(parsed(documents.state(machine_))), keys_of("system.state"));
  EXPECT_EQ(keys(parsed(documents.control())), keys_of("control.state"));
  EXPECT_EQ(keys(parsed(documents.health())), keys_of("system.health"));
  ASSERT_EQ(parsed(documents.alarms()).size(), 1U);
  EXPECT_EQ(parsed(documents.alarms())[0]["text"], "the disk is nearly full");
  const json job = parsed(documents.job(machine_));
  EXPECT_EQ(job["part_id"], "<script>") << "a text is a text";
  EXPECT_EQ(job["job_id"], "job-1");
  machine_.job.reset();
  EXPECT_EQ(documents.job(machine_).text, "null");
}

TEST_F(TopicDocumentsTest, HaveEveryKeyOfAJob) {
  const TopicDocuments documents(services_);
  JobRequest request;
  request.seq = 1;
  request.part_id = "p";
  (void)service_.start(request);
  EXPECT_EQ(keys(parsed(documents.job(machine_))), keys_of("job.status", {{"seq", 1}}));
}

TEST_F(TopicDocumentsTest, AreOneLineOfAscii) {
  machine_.error = ErrorCode::kNotReady;
  machine_.error_message = "a\nb\xc3\xbc\xff";
  service_.alarms.note(AlarmLevel::kError, "a\nb\xc3\xbc\xff", {});
  const TopicDocuments documents(services_);
  for (const TopicDocument& document : {documents.state(machine_), documents.alarms()}) {
    for (const char c : document.text) EXPECT_TRUE(c >= ' ' && c < 0x7f) << document.text;
    EXPECT_TRUE(json::accept(document.text));
  }
}

TEST_F(TopicDocumentsTest, KnowProgressFromWhatIsUrgent) {
  const TopicDocuments documents(services_);
  const TopicDocument before = documents.job(machine_);
  machine_.job->slices_done = 5;
  machine_.job->frames.ok = 5;
  const TopicDocument further = documents.job(machine_);
  EXPECT_NE(further.compared, before.compared);
  EXPECT_EQ(further.urgent, before.urgent);
  machine_.job->acquired = true;
  EXPECT_NE(documents.job(machine_).urgent, before.urgent);
}

TEST_F(TopicDocumentsTest, TakeARenewalForAChangeAndLessTimeForNone) {
  const TopicDocuments documents(services_);
  const Identity kiosk{"token kiosk", Role::kOperate};
  const std::string nobody = documents.control().compared;
  (void)service_.control.acquire({kiosk, "anna", std::chrono::seconds(60)});
  const TopicDocument anna = documents.control();
  EXPECT_NE(anna.compared, nobody);
  EXPECT_EQ(parsed(anna)["owner"], "anna");
  EXPECT_EQ(parsed(anna)["yours"], false);
  EXPECT_EQ(documents.control().compared, anna.compared);
  (void)service_.control.acquire({kiosk, "anna", std::chrono::seconds(90)});
  EXPECT_NE(documents.control().compared, anna.compared);
  service_.control.release(kiosk.name);
  EXPECT_EQ(documents.control().compared, nobody);
}

TEST_F(TopicDocumentsTest, KnowALostDeviceFromAFigure) {
  const TopicDocuments documents(services_);
  const TopicDocument before = documents.health();
  machine_.health.frames.frames_complete = 100;
  service_.machine = machine_;
  const TopicDocument counted = documents.health();
  EXPECT_NE(counted.compared, before.compared);
  EXPECT_EQ(counted.urgent, before.urgent);
  machine_.health.camera.open = !machine_.health.camera.open;
  service_.machine = machine_;
  EXPECT_NE(documents.health().urgent, before.urgent);
}

TEST_F(TopicDocumentsTest, TakeStandstillForUrgent) {
  const TopicDocuments documents(services_);
  service_.machine.signals.part_release = true;
  const TopicDocument stands = documents.health();
  service_.machine.signals.part_release = false;
  const TopicDocument moves = documents.health();
  ASSERT_NE(parsed(stands)["stage"]["standstill"], parsed(moves)["stage"]["standstill"]);
  EXPECT_NE(moves.urgent, stands.urgent);
}

TEST_F(TopicDocumentsTest, TakeNoAlarmForUrgent) {
  const TopicDocuments documents(services_);
  const TopicDocument before = documents.alarms();
  service_.alarms.note(AlarmLevel::kError, "it is warm", {});
  EXPECT_NE(documents.alarms().compared, before.compared);
  EXPECT_EQ(documents.alarms().urgent, before.urgent);
}

}  // namespace
}  // namespace fvd
