#pragma once

/// JSON-RPC 2.0 as a function from lines to lines: no sockets, no threads, no waiting.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/jobs/services.hpp"

namespace fvd {

/// A request whose answer has to wait for a job (job.wait) or for the devices.
struct WaitingRequest {
  nlohmann::json id;
  JobKey key;
  bool until_acquired = false;  ///< else until the job has ended
  std::chrono::milliseconds timeout{0};
  std::shared_ptr<DeviceTask> task{};  ///< if given, it is waited for, and key means nothing
};

/// What became of a line.
struct Handled {
  std::optional<std::string> reply;       ///< one line without terminator; absent = nothing to say
  std::optional<WaitingRequest> waiting;  ///< the answer comes later, through Dispatcher::resume
  bool is_parse_error = false;            ///< the line was no JSON
};

/// context: one thread at a time.
class Dispatcher {
 public:
  static constexpr std::size_t kMaxLineBytes = 65536;
  static constexpr std::size_t kMaxBatch = 16;

  explicit Dispatcher(const Services& services);

  /// One request or batch. Never throws. Replies are ASCII.
  [[nodiscard]] Handled handle(std::string_view line);

  /// The answer to a waiting request if what it waits for has come, or, with `timed_out`, in any case.
  [[nodiscard]] std::optional<std::string> resume(const WaitingRequest& waiting, bool timed_out);

  /// The reply to a line that is too long to be read.
  [[nodiscard]] static std::string too_long();
  /// The reply to a line of another protocol.
  [[nodiscard]] static std::string foreign_protocol();
  /// The reply to the last of too many lines that are no JSON.
  [[nodiscard]] static std::string no_json();
  /// The reply to a connection too many.
  [[nodiscard]] static std::string too_many_connections();

 private:
  using Json = nlohmann::json;
  using OrderedJson = nlohmann::ordered_json;

  enum class ParamType { kText, kInteger, kNumber, kAny };
  struct Param {
    std::string name;
    ParamType type = ParamType::kText;
    bool required = false;
    std::string meaning;
  };
  struct Method {
    std::string summary;
    std::vector<Param> params;
    std::function<OrderedJson(const Json& params)> run;
  };

  void add(const std::string& name, Method method);
  void add_system_methods();
  void add_recipe_methods();
  void add_job_methods();
  void add_result_methods();
  void add_device_methods();
  /// A method whose answer comes when its task is done.
  void add_task(const std::string& name, const std::string& summary, std::vector<Param> params,
                std::function<std::shared_ptr<DeviceTask>(const Json& params)> begin);
  [[nodiscard]] std::optional<std::string> resume_task(const WaitingRequest& waiting, bool timed_out);
  [[nodiscard]] OrderedJson describe_methods() const;
  [[nodiscard]] std::optional<OrderedJson> handle_request(const Json& request, bool in_batch, Handled& handled);
  [[nodiscard]] std::optional<OrderedJson> handle_batch(const Json& batch);
  [[nodiscard]] OrderedJson run_method(const std::string& name, const Json& params, const Json& id);
  [[nodiscard]] std::optional<WaitingRequest> as_waiting(const std::string& name, const Json& params,
                                                         const Json& id) const;
  [[nodiscard]] std::int64_t heartbeat() const;

  Services services_;
  std::map<std::string, Method> methods_;
  bool may_wait_ = false;              // the request at hand can be answered later
  std::shared_ptr<DeviceTask> begun_;  // by the method that runs
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace fvd
