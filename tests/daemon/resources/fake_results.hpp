#pragma once

/// Results of jobs as a database would tell them.

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

class FakeResults final : public ResultService {
 public:
  void add(const StoredJob& job) { jobs[job.status.job_id] = job; }

  [[nodiscard]] StoredJob stored(const JobKey& key) const override {
    asked.push_back(std::get<std::string>(key));
    const auto found = jobs.find(asked.back());
    if (found == jobs.end()) throw Error(ErrorCode::kUnknownJob, "no such job");
    return found->second;
  }
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const override { return std::nullopt; }
  int acknowledge(const JobKey&) override { return 0; }
  [[nodiscard]] std::shared_ptr<DeviceTask> evaluate(const JobKey&, const std::string&) override { return nullptr; }

  std::map<std::string, StoredJob> jobs;
  mutable std::vector<std::string> asked;  ///< ids, as they were asked for
};

}  // namespace fvd
