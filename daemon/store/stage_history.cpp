#include "daemon/store/stage_history.hpp"

#include <cerrno>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/replace_file.hpp"
#include "daemon/export/stage_report_files.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

namespace {

using Json = nlohmann::ordered_json;

Json moments_json(const RunningMoments& moments) {
  return {{"n", moments.n},
          {"mean", moments.mean},
          {"sum_of_squares", moments.sum_of_squares},
          {"max_magnitude", moments.max_magnitude}};
}

RunningMoments moments_from(const Json& json) {
  RunningMoments moments;
  moments.n = json.at("n").get<std::uint64_t>();
  moments.mean = json.at("mean").get<double>();
  moments.sum_of_squares = json.at("sum_of_squares").get<double>();
  moments.max_magnitude = json.at("max_magnitude").get<double>();
  return moments;
}

/// [[bin, count], ...] of the bins that are not empty.
Json histogram_json(const MagnitudeHistogram& histogram) {
  Json bins = Json::array();
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    if (histogram.counts[bin] != 0) bins.push_back({bin, histogram.counts[bin]});
  }
  return bins;
}

MagnitudeHistogram histogram_from(const Json& json) {
  MagnitudeHistogram histogram;
  for (const Json& entry : json) histogram.counts.at(entry.at(0).get<std::size_t>()) = entry.at(1).get<std::uint64_t>();
  return histogram;
}

FeedbackSource feedback_from(const std::string& name) {
  for (const auto source : {FeedbackSource::kNone, FeedbackSource::kMotorEncoder, FeedbackSource::kLinearScale}) {
    if (feedback_name(source) == name) return source;
  }
  throw Error(ErrorCode::kBadInput, "'" + name + "' is no kind of feedback");
}

}  // namespace

std::string step_history_json(const StepHistoryState& state) {
  const Json json{{"version", 1},
                  {"feedback", feedback_name(state.feedback)},
                  {"scans", state.scans},
                  {"steps", state.steps},
                  {"lost_steps", state.lost_steps},
                  {"error_um", moments_json(state.error)},
                  {"error_sizes_um", histogram_json(state.error_sizes)},
                  {"increment_error_um", moments_json(state.increment_error)},
                  {"move_ms", moments_json(state.move)},
                  {"move_times_ms", histogram_json(state.move_times)}};
  return json.dump() + "\n";
}

StepHistoryState parse_step_history(const std::string& json_text) {
  try {
    const Json json = Json::parse(json_text);
    if (json.at("version") != 1) throw Error(ErrorCode::kBadInput, "it is of another version of fvd");
    StepHistoryState state;
    state.feedback = feedback_from(json.at("feedback").get<std::string>());
    state.scans = json.at("scans").get<std::uint64_t>();
    state.steps = json.at("steps").get<std::uint64_t>();
    state.lost_steps = json.at("lost_steps").get<std::uint64_t>();
    state.error = moments_from(json.at("error_um"));
    state.error_sizes = histogram_from(json.at("error_sizes_um"));
    state.increment_error = moments_from(json.at("increment_error_um"));
    state.move = moments_from(json.at("move_ms"));
    state.move_times = histogram_from(json.at("move_times_ms"));
    return StepHistory(state).state();
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::kBadInput, error.what());
  } catch (const std::out_of_range& error) {
    throw Error(ErrorCode::kBadInput, std::string("a bin that no histogram has: ") + error.what());
  }
}

StageHistory::StageHistory(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code error;
  if (!std::filesystem::exists(file_, error)) return;
  try {
    history_.emplace(parse_step_history(read_text_file(file_)));
  } catch (const Error& problem) {
    move_aside(problem.what());
  }
}

void StageHistory::move_aside(const std::string& why) {
  auto aside = file_;
  aside += ".old";
  const bool moved = file_calls().rename(file_, aside) == 0;
  spdlog::warn("stage history {}: {}; {}", file_.string(), why,
               moved ? "moved to " + aside.string() : storage_error(errno, "move it to", aside).what());
}

void StageHistory::add(FeedbackSource feedback, const StepLog& log) {
  const MutexLock lock(mutex_);
  if (history_ && history_->state().feedback != feedback) {
    move_aside("the stage has another kind of feedback now");
    history_.reset();
  }
  if (!history_) history_.emplace(feedback);
  try {
    history_->add(log);
    replace_file(file_, step_history_json(history_->state()));
  } catch (const std::exception& error) {
    spdlog::error("stage history {} could not be stored: {}", file_.string(), error.what());
  }
}

std::optional<StepHistorySummary> StageHistory::summary() const {
  const MutexLock lock(mutex_);
  return history_ ? std::optional(history_->summary()) : std::nullopt;
}

}  // namespace fvd
