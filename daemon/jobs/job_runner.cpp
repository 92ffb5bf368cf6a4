#include "daemon/jobs/job_runner.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/base/log_scope.hpp"
#include "daemon/base/version.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "daemon/jobs/longest_step.hpp"
#include "daemon/jobs/part_temperature.hpp"
#include "daemon/pipeline/job_memory.hpp"
#include "daemon/pipeline/reconstruct.hpp"

namespace fvd {

namespace {

/// The recipe with what its earlier scans told of the focus curve. A database that cannot tell costs accuracy, not the
/// job.
Recipe with_learnt_width(Recipe recipe, const CurveWidthTable& widths) {
  if (!learns_bins(recipe)) return recipe;
  try {
    recipe.learnt_width = widths.find(recipe);
  } catch (const Error& failure) {
    spdlog::warn("recipe {}: the focus curve's width is not remembered: {}", recipe.id, failure.what());
  }
  return recipe;
}

/// The width that the curves of a handful of points have is no width of the scan.
constexpr double kLeastValidShare = 0.1;

void learn_width(const Recipe& recipe, const ResultData& scan, CurveWidthTable& widths) {
  const HeightMap& map = scan.map;
  const auto points = map.mask.pixels();
  const auto valid = static_cast<double>(std::count(points.begin(), points.end(), MaskReasons{0}));
  const double width_um = map.curve_width_um;
  if (!learns_bins(recipe) || !(width_um > 0.0)) return;
  if (valid < kLeastValidShare * static_cast<double>(points.size())) return;
  try {
    widths.learn(recipe, width_um, most_bin_slices(map.height_m, scan.steps, recipe.step_um));
  } catch (const Error& failure) {
    spdlog::warn("recipe {}: the focus curve's width cannot be remembered: {}", recipe.id, failure.what());
  }
}

ResultData described(const AcceptedJob& job, const Recipe& recipe, const Config& config, const std::string& objective) {
  ResultData result;
  result.software_version = kVersion;
  result.created = std::chrono::system_clock::now();
  result.simulated = config.camera.simulated || config.stage.simulated;
  result.job_id = job.status.job_id;
  result.seq = job.status.request.seq;
  result.part_id = job.status.request.part_id;
  result.objective = objective;
  note_recipe(recipe, result);
  return result;
}

/// For files of earlier results, before the scan.
constexpr std::chrono::minutes kLongestWait{60};

}  // namespace

void JobRunner::run(const AcceptedJob& job, const std::stop_token& stop) {
  const JobRequest& request = job.status.request;
  const LogScope scope({job.status.job_id, request.part_id, request.client});
  if (stop.stop_requested()) {
    if (halted()) return refuse(job);
    return end(job, {.state = JobState::kAborted,
                     .error = ErrorCode::kAborted,
                     .message = "the job was aborted before it began",
                     .used_devices = false});
  }
  spdlog::info("job {} starts: client {}, seq {}, part '{}', recipe {}", job.status.job_id, request.client, request.seq,
               request.part_id, job.recipe.id);
  deps_.preview.clear();
  longest_step_ = longest_step(job.recipe, {});  // of the stage nothing is known yet
  deps_.ticks.tick(HostClock::now(), longest_step_);
  if (const auto failure = deps_.hub.open()) {
    return end(job, {.error = failure->code, .message = failure->message, .failure = failure});
  }
  longest_step_ = longest_step(job.recipe, deps_.hub.facts().stage);
  JobEnd ended = measured(job, stop);
  end(job, ended);
  JobResult& result = ended.result;
  if (!result.files_pending) return;
  deps_.following.add({job.status.job_id, result.directory, std::move(result.text), std::move(result.written)});
}

void JobRunner::wait_for_memory(const AcceptedJob& job, const std::stop_token& stop) {
  const auto budget = static_cast<std::size_t>(deps_.config.compute.memory_budget_mib) << 20U;
  const CameraSettings& camera = job.recipe.camera;
  const DeviceFacts facts = deps_.hub.facts();
  const std::size_t needed =
      job_memory(job.recipe, camera.width > 0 ? camera.width : facts.camera.sensor_width,
                 camera.height > 0 ? camera.height : facts.camera.sensor_height, deps_.pool.threads())
          .total_bytes();
  const std::size_t others = deps_.following.bytes();
  if (others + needed + (deps_.pages ? deps_.pages->kept_bytes() : 0) <= budget) return;
  if (deps_.pages) deps_.pages->release();
  const std::size_t room = budget - std::min(budget, needed);
  if (others <= room) return;
  spdlog::info("job {} waits for files of results before it: they take {} MiB, it needs {} MiB of {} MiB",
               job.status.job_id, others >> 20U, needed >> 20U, budget >> 20U);
  deps_.ticks.tick(HostClock::now(), kLongestWait);
  if (!deps_.following.wait_for(room, stop)) {
    throw Error(ErrorCode::kAborted, "stopped while it waited for files of results before it");
  }
}

void JobRunner::refuse(const AcceptedJob& job) {
  end(job, {.error = ErrorCode::kShuttingDown,
            .message = "the daemon was shut down before this could begin; ask again when it is back",
            .used_devices = false});
}

JobRunner::JobEnd JobRunner::measured(const AcceptedJob& job, const std::stop_token& stop) {
  try {
    JobEnd end{.state = JobState::kCompleted, .result = acquire_and_store(job, stop)};
    if (end.result.error) {
      end.state = JobState::kFailed;
      end.error = end.result.error;
      end.message = end.result.message;
    }
    end.failure = deps_.hub.failure();
    return end;
  } catch (const Error& error) {
    return failed(error.code(), error.what());
  } catch (const std::exception& error) {
    return failed(ErrorCode::kInternal, error.what());
  }
}

JobResult JobRunner::acquire_and_store(const AcceptedJob& job, const std::stop_token& stop) {
  wait_for_memory(job, stop);
  const Recipe recipe = with_learnt_width(job.recipe, deps_.store.curve_widths());
  ResultData acquired = described(job, recipe, deps_.config, deps_.board.read().objective);
  note_constants(recipe, deps_.calibrations, deps_.repeatability, acquired);
  // Made when the first slice is there: a file system that is writing may hold up who makes a directory, and between a
  // trigger and the first motion nobody is to wait for it.
  std::optional<AtomicDirectory> directory;
  const auto need_directory = [&] {
    if (!directory) directory.emplace(deps_.config.paths.state_dir / "results" / job.status.job_id);
  };
  MeasurementObserver observer = this->observer();
  const auto tell_phase = observer.on_phase;
  observer.on_phase = [&](std::string_view phase) {
    // The temperature is that of the scan, not that of a homing before it.
    if (phase == "acquiring") note_temperature(job.status.request, deps_.config.temperature, acquired);
    tell_phase(phase);
  };
  // In a continuous scan nobody commands the stage to be just there; and the history is of one direction.
  const auto remember_steps = [this, &recipe](const StepLog& steps) {
    if (recipe.mode == ScanMode::kStep && !recipe.downwards) deps_.history.add(deps_.hub.axis().info().feedback, steps);
  };
  observer.on_earlier_scan = remember_steps;
  std::optional<SliceRecorder> recorder;
  observer.tap = [&](const ImageView& pixels, double z_um) {
    need_directory();
    if (recipe.keep_slices && !recorder) recorder.emplace(*directory);
    if (recorder) recorder->add(pixels, z_um);
    deps_.preview.offer(pixels, z_um);
  };
  std::optional<FirstFilesWriter> files;
  observer.on_maps = [&] {
    need_directory();
    if (recorder) recorder->finish("job " + job.status.job_id, acquired.simulated);
    files.emplace(*directory, acquired);  // while it is evaluated
  };
  measure(recipe,
          {deps_.hub.camera(), deps_.hub.axis(), deps_.clock, deps_.pool, deps_.pages,
           static_cast<std::size_t>(deps_.config.compute.queue_slices), deps_.config.camera.time_offset},
          observer, acquired, stop);
  observer.on_phase("storing");
  remember_steps(acquired.steps);
  JobResult result = deps_.make_result(*directory, acquired, files ? &*files : nullptr);
  if (!result.error) learn_width(recipe, acquired, deps_.store.curve_widths());
  return result;
}

JobRunner::JobEnd JobRunner::failed(ErrorCode code, const std::string& message) {
  const bool aborted = code == ErrorCode::kAborted;
  return {.state = aborted ? JobState::kAborted : JobState::kFailed,
          .error = aborted && halted() ? ErrorCode::kShuttingDown : code,
          .message = message,
          .failure = deps_.hub.after_failure(code, message)};
}

MeasurementObserver JobRunner::observer() {
  const auto change_job = [this](const std::function<void(MachineRecord&, JobStatus&)>& change) {
    deps_.board.update([&change](MachineRecord& machine) { change(machine, *machine.job); });
  };
  MeasurementObserver observer;
  observer.on_phase = [this, change_job](std::string_view phase) {
    deps_.ticks.tick(HostClock::now(), longest_step_);
    const auto shown = deps_.board.snapshot()->job;
    if (shown && shown->phase == phase) return;  // as at the start: an accepted job is told as preparing
    change_job([phase](MachineRecord&, JobStatus& job) { job.phase = phase; });
  };
  observer.on_slice = [this, change_job](const SliceProgress& progress) {
    deps_.ticks.tick(HostClock::now(), longest_step_);
    change_job([&progress](MachineRecord&, JobStatus& job) {
      job.slices_done = progress.slices;
      job.frames = progress.frames;
    });
  };
  observer.on_acquired = [this, change_job] {
    deps_.hub.confirm_rest();  // before anybody is told that the part is free
    change_job([](MachineRecord& machine, JobStatus& job) {
      job.acquired = machine.state.at_rest;
      machine.apply(MachineEvent::kJobAcquired);
    });
  };
  return observer;
}

void JobRunner::end(const AcceptedJob& job, const JobEnd& end) {
  if (end.error) {
    // What somebody asked for is no error, unless the stage did not come to rest.
    spdlog::log(end.state == JobState::kAborted && !end.failure ? spdlog::level::warn : spdlog::level::err,
                "job {} {}: {}: {}", job.status.job_id, job_state_name(end.state), error_name(*end.error), end.message);
  } else {
    spdlog::info("job {} completed: {}", job.status.job_id, end.result.directory);
  }
  JobStatus ended = deps_.board.read().job.value_or(job.status);
  ended.state = end.state;
  ended.phase.clear();
  ended.acquired = ended.acquired || deps_.board.read().state.at_rest;
  ended.error = end.error;
  ended.error_message = end.message;
  ended.ended_utc = utc_now();
  ended.verdict = end.result.verdict;
  ended.reason_codes = end.result.reason_codes;
  // The row is durable before anybody can see the job's end; a database that fails must not hide how it ended.
  std::optional<StorageProblem> storage;
  try {
    deps_.store.finish(ended, end.result.directory, end.result.text, end.result.files_pending, end.result.values);
  } catch (const Error& failure) {
    spdlog::critical("job {}: its end is not stored yet, no job is taken before it is: {}", ended.job_id,
                     failure.what());
    ended.not_durable = failure.what();
    storage = StorageProblem{failure.code(), deps_.store.kept_end()};
  }
  const std::optional<DeviceFailure> alarm = end.used_devices ? deps_.hub.alarm() : std::nullopt;
  deps_.board.update([&](MachineRecord& machine) {
    if (machine.job) ended.acknowledged = machine.job->acknowledged;  // by a client that saw the row
    machine.job = ended;
    machine.apply(MachineEvent::kJobEnded);
    if (storage) machine.set_storage(storage);
    if (end.used_devices) {
      machine.set_devices(end.failure);
      machine.set_alarm(alarm);
    }
    machine.apply(MachineEvent::kRecipePrepared);  // by the job, on the way
  });
}

void JobRunner::look_after_storage() {
  store_late_end();
  const auto known = deps_.board.read().storage;
  auto problem = deps_.storage.look();
  if (const std::string kept = deps_.store.kept_end(); !problem && !kept.empty()) {
    const bool was_told = known && known->message == kept;  // with the code of its cause
    problem = was_told ? known : StorageProblem{ErrorCode::kDatabase, kept};
  }
  if (problem == known) return;
  if (problem) {
    spdlog::error("no job is taken: {}: {}", error_name(problem->code), problem->message);
  } else {
    spdlog::info("results can be kept again");
  }
  deps_.board.update([&problem](MachineRecord& machine) { machine.set_storage(problem); });
}

void JobRunner::store_late_end() {
  const auto late = deps_.board.snapshot()->job;
  if (!late || late->not_durable.empty()) return;
  try {
    deps_.store.store_kept_ends();
  } catch (const Error&) {
    return;  // it was told when the job ended
  }
  deps_.board.update([&late](MachineRecord& machine) {
    if (machine.job && machine.job->job_id == late->job_id) machine.job->not_durable.clear();
  });
}

}  // namespace fvd
