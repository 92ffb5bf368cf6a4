/// The engine's thread: one job from its start to its durable end.

#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/base/version.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/jobs/engine.hpp"

namespace fvd {

MeasurementObserver Engine::observer_of_current() {
  MeasurementObserver observer;
  observer.on_phase = [this](std::string_view phase) {
    update_current([phase](JobStatus& job) { job.phase = phase; });
  };
  observer.on_slice = [this](const ScanReport& report) {
    update_current([&report](JobStatus& job) {
      job.slices_done = static_cast<int>(report.steps.size());
      job.frames = report.frames;
    });
  };
  observer.on_acquired = [this] { update_current([](JobStatus& job) { job.acquired = true; }); };
  return observer;
}

void Engine::run_job(const PendingJob& job, std::stop_token stop) {
  spdlog::info("job {} starts: seq {}, part '{}', recipe {}", job.status.job_id, job.status.request.seq,
               job.status.request.part_id, job.recipe.id);
  preview_.clear();
  ResultData result;
  result.software_version = kVersion;
  result.created = std::chrono::system_clock::now();
  result.simulated = config_.camera.simulated || config_.stage.simulated;
  result.job_id = job.status.job_id;
  result.seq = job.status.request.seq;
  result.part_id = job.status.request.part_id;
  result.recipe_id = job.recipe.id;
  result.recipe_sha256 = job.recipe.sha256;
  result.focus = focus_settings(job.recipe);
  result.peak = job.recipe.peak;
  result.pixel_pitch_x_um = job.recipe.pixel_pitch_x_um;
  result.pixel_pitch_y_um = job.recipe.pixel_pitch_y_um;
  if (const auto failure = open_devices()) {
    end_job(job, {.error = failure->code, .message = failure->message, .failure = failure});
    return;
  }
  try {
    AtomicDirectory directory(config_.paths.state_dir / "results" / job.status.job_id);
    MeasurementObserver observer = observer_of_current();
    std::optional<SliceRecorder> recorder;
    if (job.recipe.keep_slices) recorder.emplace(directory);
    observer.tap = [&recorder, this](const ImageView& pixels, double z_um) {
      if (recorder) recorder->add(pixels, z_um);
      preview_.offer(pixels, z_um);
    };
    measure(job.recipe,
            {camera_.get(), stage_.get(), clock_, pool_, static_cast<std::size_t>(config_.compute.queue_slices),
             config_.camera.time_offset},
            observer, result, stop);
    observer.on_phase("storing");
    // In a continuous scan nobody commands the stage to be just there.
    if (job.recipe.mode == ScanMode::kStep) stage_history_.add(stage_.get().info().feedback, result.steps);
    if (recorder) recorder->finish("job " + job.status.job_id + (result.simulated ? ", simulated" : ""));
    write_result(directory, result, chosen_exporters(job.recipe.exports));
    directory.commit();
    const std::string text = read_text_file(directory.final_dir() / "result.json");
    JobEnd end{.state = JobState::kCompleted, .directory = directory.final_dir().string(), .result_text = text};
    try {
      check_valid_points(job.recipe, result.map);
    } catch (const Error& error) {
      end.state = JobState::kFailed;
      end.error = error.code();
      end.message = error.what();
    }
    end.failure = lost_device();
    end_job(job, end);
  } catch (const Error& error) {
    const bool aborted = error.code() == ErrorCode::kAborted;
    end_job(job, {.state = aborted ? JobState::kAborted : JobState::kFailed,
                  .error = aborted ? abort_reason() : error.code(),
                  .message = error.what(),
                  .failure = failure_behind(error.code(), error.what())});
  } catch (const std::exception& error) {
    end_job(job, {.error = ErrorCode::kInternal,
                  .message = error.what(),
                  .failure = failure_behind(ErrorCode::kInternal, error.what())});
  }
}

ErrorCode Engine::abort_reason() const {
  const MutexLock lock(mutex_);
  return shutting_down_ ? ErrorCode::kShuttingDown : ErrorCode::kAborted;
}

void Engine::end_job(const PendingJob& job, const JobEnd& end) {
  if (end.error) {
    spdlog::error("job {} {}: {}: {}", job.status.job_id, job_state_name(end.state), error_name(*end.error),
                  end.message);
  } else {
    spdlog::info("job {} completed: {}", job.status.job_id, end.directory);
  }
  JobStatus ended;
  {
    const MutexLock lock(mutex_);
    ended = *current_;
  }
  ended.state = end.state;
  ended.phase.clear();
  ended.acquired = true;
  ended.error = end.error;
  ended.error_message = end.message;
  // The row is durable before anybody can see the job's end; a database that fails must not hide that it ended.
  try {
    store_.finish(ended, end.directory, end.result_text);
  } catch (const Error& failure) {
    spdlog::critical("job {}: its end could not be stored: {}", ended.job_id, failure.what());
    ended.state = JobState::kFailed;
    ended.error = failure.code();
    ended.error_message = failure.what();
  }
  {
    const MutexLock lock(mutex_);
    current_ = ended;
    if (end.failure) failure_ = end.failure;
    transition_locked(end.failure ? ScanEvent::kDevicesDown : ScanEvent::kJobEnded);
    publish_locked();
  }
  notify();
}

void Engine::update_current(const std::function<void(JobStatus&)>& change) {
  {
    const MutexLock lock(mutex_);
    change(*current_);
    publish_locked();
  }
  notify();
}

}  // namespace fvd
