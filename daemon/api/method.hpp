#pragma once

/// What a method of the API is: its name, its parameters, and how it is answered.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/jobs/services.hpp"

namespace fvd {

/// Integers up to here survive a client that keeps numbers as doubles.
inline constexpr std::int64_t kLargestExactInteger = (std::int64_t{1} << 53U) - 1;

/// The value of a whole number within +-kLargestExactInteger, written as 4711 or as 4711.0; nothing for all else.
[[nodiscard]] std::optional<std::int64_t> exact_integer(const nlohmann::json& value);

enum class ParamType { kText, kInteger, kNumber, kAny };

/// Both ends belong to it.
struct ParamRange {
  double least = 0.0;
  double most = 0.0;
};

struct Param {
  std::string name;
  ParamType type = ParamType::kText;
  bool required = false;
  std::string meaning;
  std::optional<ParamRange> range{};  ///< of integers and numbers
};

/// What a method is given.
struct Call {
  const nlohmann::json& params;  ///< checked, by name; integers as integers
  bool may_wait = false;         ///< the reply may come later: not in a batch
};

/// The reply comes when a job has got so far (until_acquired, else until it has ended).
struct JobWait {
  std::string job_id;
  bool until_acquired = false;
};

/// The reply comes later.
struct Deferred {
  std::variant<JobWait, std::shared_ptr<DeviceTask>> awaited;
  std::chrono::milliseconds timeout{0};
};

using Reply = std::variant<nlohmann::ordered_json, Deferred>;

/// context: peek and run on any thread.
struct Method {
  std::string summary;
  std::vector<Param> params;
  /// Answers from the machine's snapshot alone: no file, no database, no lock that is held across either. Nothing if
  /// that does not suffice and run has to answer.
  std::function<std::optional<Reply>(const Call&)> peek{};
  /// May block for files, the database and the devices' state. Throws Error, ProtocolError.
  std::function<Reply(const Call&)> run{};
  bool needs_id = false;  ///< refused as a notification: it moves something, and somebody has to know
};

using MethodTable = std::map<std::string, Method>;

/// The parameters by name, every one known and of its type and range, the required ones there; texts have at most 64
/// bytes. given: an object, a list in the order of the method's parameters, or null. Throws ProtocolError that names
/// the parameter and its range.
[[nodiscard]] nlohmann::json checked_params(const std::string& method_name, const std::vector<Param>& known,
                                            const nlohmann::json& given);

}  // namespace fvd
