#include "daemon/api/line_contract.hpp"

#include <array>
#include <string_view>

#include "daemon/api/reply_form.hpp"

namespace fvd {

namespace {

constexpr std::array<std::string_view, 10> kOrder{
    "connect; without success try again for as long as it takes: the daemon listens when its database is open",
    "once after a start of the line's program without its memory: job.latest; the next seq is newest_seq + 1, and "
    "session another text than before",
    "a part is there: system.state until `ready`, for it opens the devices later than its port; while `state` is error "
    "look at error_code",
    "job.start with seq, part_id, session, and recipe by its name: without one the part is measured by the prepared "
    "one, which is that of the last job or recipe.prepare of any client; without a reply in time a new connection, "
    "and the same again: nothing moves twice",
    "job.status until `acquired`: the part may go, until the next one is there; remember that it was let go",
    "job.status until `done`: the result is there; result_valid of system.state says so of any client's completed jobs",
    "result.get; compare seq and part_id, look at state and error_code, then keep it",
    "result.ack, and seq + 1 for the next part; where the job has ended without `acquired`, then system.state until "
    "`part_release`: the part may go",
    "a job that ended with 1014: with the part still there result.ack, and the same part with seq + 1; if it was let "
    "go "
    "it has no result: people, for what lies there may be another part",
    "job.start refused with 1009: job.latest, and newest_seq + 1; with 1010 or 1014 job.status of the number first: "
    "its "
    "job may be this part's, whose reply was lost, and only without one (1007) job.latest; an error with retry (1001, "
    "1002, 1003, 1013): the same request again, and people where 1003 lasts; after any other: people",
};

struct Time {
  std::string_view key;
  int value;
  std::string_view meaning;
};
constexpr std::array<Time, 8> kTimes{{
    {"connect_ms", 3000, "for a connection; then try again"},
    {"reply_ms", 1000, "for a reply; then a new connection and the same request"},
    {"wait_extra_ms", 1000, "for the reply to job.wait, beyond its timeout_ms; other requests are answered meanwhile"},
    {"retry_ms", 500, "pause before the next attempt to connect"},
    {"poll_ms", 100, "pause between two polls; 50 to 200 are usual"},
    {"heartbeat_ms", 1000, "after so much silence system.ping, or an empty line, which has no answer"},
    {"heartbeats_missed", 3, "so many replies missed: the daemon or the network is gone"},
    {"reply_bytes", static_cast<int>(kCompactReply_bytes),
     "of the longest compact reply, and of the errors of methods that a line polls"},
}};

}  // namespace

nlohmann::ordered_json line_contract_json() {
  nlohmann::ordered_json times;
  for (const Time& time : kTimes) times[std::string(time.key)] = {{"value", time.value}, {"meaning", time.meaning}};
  return {{"order", kOrder}, {"times", times}};
}

std::string line_contract_markdown() {
  std::string text = "Order of a line's requests:\n\n";
  for (std::size_t i = 0; i < kOrder.size(); ++i) text += std::to_string(i + 1) + ". " + std::string(kOrder[i]) + "\n";
  text += "\n| a client's patience | | |\n|---|---|---|\n";
  for (const Time& time : kTimes) {
    text += "| `" + std::string(time.key) + "` | " + std::to_string(time.value) + " | " + std::string(time.meaning) +
            " |\n";
  }
  return text;
}

}  // namespace fvd
