#pragma once

/// JSON-RPC 2.0 as a function from lines to lines: no sockets, no threads, no waiting.

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "daemon/access/access_error.hpp"
#include "daemon/api/method.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// A request whose answer has to wait for a job (job.wait) or for the devices.
struct WaitingRequest {
  nlohmann::json id;
  Deferred until;
};

/// The outcome of handling a line.
struct Handled {
  std::optional<std::string> reply{};       ///< one line without terminator; absent = nothing to say
  std::optional<WaitingRequest> waiting{};  ///< the answer comes later, through Dispatcher::resume
  std::optional<Identity> log_in{};         ///< the caller is that one from now on
  bool is_parse_error = false;              ///< the line was no JSON
  bool is_accepted = false;                 ///< it asked for something that exists and that the caller may
};

/// context: thread-safe; keeps no state between calls.
class Dispatcher {
 public:
  static constexpr std::size_t kMaxLineBytes = 65536;
  static constexpr std::size_t kMaxBatch = 16;

  /// services: gives the states of the machine and of the jobs that requests wait for.
  Dispatcher(MethodTable methods, const Services& services);

  /// One request or batch. Never throws. Replies are ASCII. May block for files and the database.
  [[nodiscard]] Handled handle(std::string_view line, const Caller& caller) const;
  /// Handles a line that needs neither file nor database; never blocks. Returns nothing, and executes nothing, if the
  /// line has to go to handle().
  [[nodiscard]] std::optional<Handled> try_handle(std::string_view line, const Caller& caller) const;

  /// What a line stands behind on its connection.
  enum class Behind { kWork, kWait };
  /// The method of a line with a single request that may overtake others where try_handle() answers it; null for any
  /// other line. Valid as long as the dispatcher.
  [[nodiscard]] const Method* overtaker(std::string_view line) const;
  /// Whether such a request of that caller may overtake what is open: an urgent one always, any while the open one
  /// waits for a job or the devices. Costs nothing.
  [[nodiscard]] static bool may_overtake(const Method& method, const Caller& caller, Behind behind);
  /// The running or the latest job: an urgent request that try_handle() could not answer waits for another one.
  [[nodiscard]] std::string job_on_board() const;

  /// True for a line with a single request that only says who the caller is: nobody waits behind slow calls for that.
  [[nodiscard]] bool is_log_in(std::string_view line) const;
  /// True for a line with a request, or a batch with one, that reads much for people: nobody waits behind it for what a
  /// line needs.
  [[nodiscard]] bool is_long(std::string_view line) const;

  /// Every method with its description.
  [[nodiscard]] const MethodTable& methods() const noexcept { return methods_; }

  /// The answer to a waiting request if its job or command has got so far; with `timed_out` in any case. May block.
  [[nodiscard]] std::optional<std::string> resume(const WaitingRequest& waiting, bool timed_out) const;
  /// False if the machine's snapshot shows that resume() would return nothing. Never blocks.
  [[nodiscard]] bool may_have_come(const WaitingRequest& waiting) const;

  /// The answer to a waiting request when the daemon ends.
  [[nodiscard]] std::string ended(const WaitingRequest& waiting) const;

  /// The reply to a line that is too long to be read.
  [[nodiscard]] static std::string too_long();
  /// The reply to a line of another protocol.
  [[nodiscard]] static std::string foreign_protocol();
  /// The reply to what is no line of JSON text because of a mistake that can be named.
  [[nodiscard]] static std::string mistaken(std::string_view mistake);
  /// The reply to the last of too many lines that are no JSON.
  [[nodiscard]] static std::string no_json();
  /// The reply to a connection from where nobody may do anything.
  [[nodiscard]] static std::string not_allowed_here();
  /// The reply to a connection above the limit.
  [[nodiscard]] static std::string too_many_connections();

 private:
  using Json = nlohmann::json;
  using OrderedJson = nlohmann::ordered_json;

  /// How a request is to be handled.
  struct Mode {
    bool may_block = false;
    bool in_batch = false;
  };
  /// The outcome of handling one request.
  struct Outcome {
    std::optional<OrderedJson> reply{};
    std::optional<WaitingRequest> waiting{};
    std::optional<Identity> log_in{};
    bool is_accepted = false;
    bool would_block = false;  ///< nothing was executed: handle() has to take the line
  };

  /// Of a line with a single request; null for any other.
  [[nodiscard]] const Method* method_of(std::string_view line) const;
  /// Null for what names none.
  [[nodiscard]] const Method* method_in(const Json& request) const;
  [[nodiscard]] std::optional<Handled> handle_line(std::string_view line, const Caller& caller, bool may_block) const;
  [[nodiscard]] Outcome handle_request(const Json& request, const Caller& caller, Mode mode) const;
  [[nodiscard]] Outcome handle_batch(const Json& batch, const Caller& caller, bool may_block) const;
  void run_method(const Json& request, const Json& id, Caller caller, Mode mode, Outcome& outcome) const;
  /// True for requests whose error replies are short: of methods that a PLC polls, and of none.
  [[nodiscard]] bool is_brief(const Json& request) const;
  /// The method's answer; nothing if it would block and may not. Notes who asked and what came of it.
  [[nodiscard]] std::optional<Answer> answer_of(const Method& method, const Call& call, bool may_block) const;
  void note(const Method& method, const Call& call, std::string_view outcome) const;
  /// Another row once the task has ended.
  void note_outcome_of(DeviceTask& task, const Call& call) const;
  [[nodiscard]] static AuditEntry audit_entry(const Call& call, std::string_view outcome);
  /// The same for who may not; of callers without a role none is written down.
  void note_refusal(const Method& method, const Call& call, const AccessError& error) const;
  /// Warns of a refusal, as RefusedCalls lets it.
  void warn_of(const Caller& caller, const std::string& text, const std::string& details = {}) const {
    services_.refusals.tell(caller.who.name, text, details);
  }

  Services services_;
  const MethodTable methods_;
};

}  // namespace fvd
