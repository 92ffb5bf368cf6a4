#pragma once

/// The stage's errors over all scans, kept in a file so that years of them can be looked at.

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/mutex.hpp"
#include "core/stage/step_history.hpp"

namespace fvd {

/// As JSON: sparse histograms, a few kB. Throws Error kBadInput (reading) naming what cannot be.
[[nodiscard]] std::string step_history_json(const StepHistoryState& state);
[[nodiscard]] StepHistoryState parse_step_history(const std::string& json_text);

/// context: thread-safe.
class StageHistory {
 public:
  /// A missing file is an empty history; one that cannot be read is moved aside, with a message in the log.
  explicit StageHistory(std::filesystem::path file);

  /// Adds a scan and stores the whole. A history of another kind of feedback is moved aside: it was of another stage. A
  /// file that cannot be written is logged and tried again with the next scan: no measurement fails for it.
  void add(FeedbackSource feedback, const StepLog& log);

  /// Nothing before the first scan.
  [[nodiscard]] std::optional<StepHistorySummary> summary() const;

 private:
  void move_aside(const std::string& why);

  const std::filesystem::path file_;
  mutable Mutex mutex_;
  std::optional<StepHistory> history_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
