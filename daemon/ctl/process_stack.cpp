#include "daemon/ctl/process_stack.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
#include "core/focus/fit/smooth_heights.hpp"
#include "core/focus/judge/slice_gate.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/base/version.hpp"
#include "daemon/ctl/stack_check.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/pipeline/reconstruct.hpp"
#include "drivers/replay/recorded_stack.hpp"

namespace fvd::ctl {

namespace {

using SteadyClock = std::chrono::steady_clock;

double milliseconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
}

/// Absolute, without a slash at its end.
std::filesystem::path named_path(const std::filesystem::path& path) {
  const auto whole = std::filesystem::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

/// What would only come out after minutes of computing otherwise.
void check_options(const ProcessOptions& options) {
  check_focus_settings(focus_settings(options.recipe));
  for (const double pitch_um : {options.recipe.pixel_pitch_x_um, options.recipe.pixel_pitch_y_um}) {
    if (std::isfinite(pitch_um) && pitch_um > 0) continue;
    throw Error(ErrorCode::kBadInput,
                "a pixel pitch of " + std::to_string(pitch_um) + " um: it must be finite and above 0");
  }
  const auto& smooth_px = options.recipe.smooth_px;
  if (smooth_px && !(*smooth_px >= kMinSmoothPx && *smooth_px <= kMaxSmoothPx)) {
    throw Error(ErrorCode::kBadInput, "smoothing over " + std::to_string(*smooth_px) + " px: must be within 1..16 px");
  }
  const std::filesystem::path parent = named_path(options.out).parent_path();
  if (!std::filesystem::is_directory(parent)) {
    throw Error(ErrorCode::kStorageWrite, "there is no folder " + parent.string() + " to make the result in");
  }
  if (std::filesystem::exists(std::filesystem::symlink_status(options.out))) {  // a link to nothing, too
    throw Error(ErrorCode::kStorageWrite, options.out.string() + " exists already: give another name, or move it away");
  }
}

std::string counted_text(int used, std::size_t ignored) {
  return std::to_string(used) + " used + " + std::to_string(ignored) +
         " ignored = " + std::to_string(static_cast<std::size_t>(used) + ignored);
}

/// "11 used + 2 ignored = 13", and the same of pages: nothing is left out in silence.
std::string files_text(const SliceList& list) {
  std::string text = counted_text(list.used_files, list.ignored.size());
  if (list.used_pages == 0) return text;
  text += "; pages: " + counted_text(list.used_pages, list.ignored_pages.size());
  constexpr std::size_t kNamed = 6;
  for (std::size_t i = 0; i < std::min(kNamed, list.ignored_pages.size()); ++i) {
    text += (i == 0 ? " (ignored: " : ", ") + list.ignored_pages[i];
  }
  if (list.ignored_pages.size() > kNamed) text += ", ...";
  return list.ignored_pages.empty() ? text : text + ")";
}

StepRecord step_record(int index, double z_um) {
  StepRecord step;
  step.index = index;
  step.commanded_um = z_um;
  step.quantised_um = z_um;
  step.measured_um = z_um;
  step.frame_id = static_cast<std::uint64_t>(index) + 1;
  return step;
}

void describe(ResultData& data, const ProcessOptions& options, const Recipe& recipe, const RecordedStack& stack) {
  data.software_version = kVersion;
  data.created = std::chrono::system_clock::now();
  const std::filesystem::path source = named_path(options.source);
  data.part_id = options.part_id.empty() ? source.filename().string() : options.part_id;
  data.source = source.string() + ": " + stack.list().description + "; files: " + files_text(stack.list());
  note_recipe(recipe, data);
  if (!options.knows_pixel_pitch) {
    data.pixel_pitch_x_um = stack.list().pixel_pitch_x_um;
    data.pixel_pitch_y_um = stack.list().pixel_pitch_y_um;
  }
  data.warnings = options.warnings;
  if (recipe.repeat > 1) {
    data.warnings.push_back({"one_scan", "the recipe asks for " + std::to_string(recipe.repeat) +
                                             " scans at /acquire/repeat; recorded slices are one"});
  }
  data.slices_planned = stack.slices();
  data.simulated = options.simulated;
}

/// Reads a batch of slices at a time and hands on those that are believed.
class SliceFeed {
 public:
  /// focus: null to measure the drift alone.
  SliceFeed(StreamingFocusStack* focus, WorkerPool& pool, const RecordedStack& stack, int allowed_lost_slices,
            DriftPath drift)
      : focus_(focus),
        pool_(pool),
        stack_(stack),
        gate_(allowed_lost_slices,
              [&stack](int index) { return stack.list().slices.at(static_cast<std::size_t>(index)).name(); }),
        undo_(std::move(drift)) {}

  void run(const std::vector<double>& z_um, ResultData& data, const std::function<void(int, int)>& on_slice) {
    for (int first = 0; first < stack_.slices(); first += StreamingFocusStack::kMaxBatch) {
      const int end = std::min(first + StreamingFocusStack::kMaxBatch, stack_.slices());
      read(first, end);
      for (int index = first; index < end; ++index) {
        const double z = z_um[static_cast<std::size_t>(index)];
        data.steps.push_back(step_record(index, z));
        ++data.frames.expected;
        ++data.frames.ok;
        const auto place = static_cast<std::size_t>(index - first);
        const ImageView view = read_[place].image.view();
        gate_.push(std::move(read_[place]), view, std::move(figures_[place]), index, z, pass_);
      }
      compute();
      if (on_slice) on_slice(end, stack_.slices());
    }
    gate_.finish(pass_);
    compute();
    note_light(gate_.suspects(), gate_.flicker_percent(), data);
    note_drift(drift_, undo_.border(), data);
  }
  [[nodiscard]] DriftPath drift() const { return drift_.path(); }

 private:
  struct ReadSlice {
    SliceImage image;
    SlicePatches patches;
  };
  struct Believed {
    ReadSlice read;
    double z_um;
    double gain;
  };

  /// Into read_ and figures_; decoding takes as long as computing.
  void read(int first, int end) {
    read_.resize(static_cast<std::size_t>(end - first));
    figures_.resize(read_.size());
    for (ReadSlice& slice : read_) {
      if (spare_.empty()) break;
      slice.image = std::move(spare_.back());
      spare_.pop_back();
    }
    const auto body = [&](int i) {
      const auto place = static_cast<std::size_t>(i);
      stack_.read(first + i, read_[place].image);
      const ImageView view = read_[place].image.view();
      figures_[place] = slice_figures(view);
      read_[place].patches = slice_patches(view);
    };
    pool_.run(end - first, std::ref(body));
  }

  void compute() {
    batch_.clear();
    for (Believed& slice : believed_) {
      const SliceImage& image = slice.read.image;
      drift_.add(std::move(slice.read.patches), slice.z_um);
      batch_.push_back({image.view(), slice.z_um, image.colour.empty() ? nullptr : image.colour.data(), slice.gain});
    }
    if (focus_ != nullptr) {
      undo_.apply(batch_);
      focus_->push(batch_);
    }
    for (Believed& slice : believed_) spare_.push_back(std::move(slice.read.image));
    believed_.clear();
  }

  StreamingFocusStack* focus_;
  WorkerPool& pool_;
  const RecordedStack& stack_;
  SliceGate<ReadSlice> gate_;
  SliceGate<ReadSlice>::Pass pass_ = [this](ReadSlice&& slice, double z_um, double gain) {
    believed_.push_back({std::move(slice), z_um, gain});
  };
  DriftMeter drift_;
  DriftUndo undo_;
  std::vector<ReadSlice> read_;
  std::vector<SliceFigures> figures_;
  std::vector<Believed> believed_;
  std::vector<SliceImage> spare_;  // whose memory is used again
  std::vector<ZSlice> batch_;
};

/// One pass over the slices, to their map.
class Pass {
 public:
  Pass(const Recipe& recipe, const RecordedStack& stack, int allowed_lost_slices, DriftPath drift, WorkerPool& pool)
      : recipe_(recipe),
        allowed_lost_slices_(allowed_lost_slices),
        drift_(std::move(drift)),
        pool_(pool),
        focus_(stack.width(), stack.height(), stack.format(), focus_settings(recipe), pool, stack.colour()) {}

  void run(const RecordedStack& stack, const std::vector<double>& z_um, ResultData& data,
           const std::function<void(int, int)>& on_slice) {
    const auto scan_start = SteadyClock::now();
    SliceFeed(&focus_, pool_, stack, allowed_lost_slices_, drift_).run(z_um, data, on_slice);
    data.times.scan_ms += milliseconds_since(scan_start);
    const auto finish_start = SteadyClock::now();
    reconstruct(focus_, recipe_, data);
    data.times.finish_ms += milliseconds_since(finish_start);
  }
  void further(ResultData& data) {
    reconstruct_further(focus_, recipe_, pool_, data);
    evaluate_as_asked(recipe_, pool_, data);
  }

 private:
  const Recipe& recipe_;
  int allowed_lost_slices_;
  DriftPath drift_;
  WorkerPool& pool_;
  StreamingFocusStack focus_;
};

/// Takes over the width that a pass without bins told. Whether it wants bins.
bool learn_bins(Recipe& recipe, ResultData& data) {
  if (!learns_bins(recipe) || !(data.map.curve_width_um > 0.0)) return false;
  recipe.learnt_width = LearntWidth{.width_um = data.map.curve_width_um,
                                    .most_bin_slices = most_bin_slices(data.map.height_m, data.steps, recipe.step_um)};
  data.bins_by = bin_choice(recipe);
  return focus_settings(recipe).bin_slices > 1;
}

/// What is to be undone, after a pass over the slices where they have to show it.
DriftPath drift_of(const ProcessOptions& options, const RecordedStack& stack, const std::vector<double>& z_um,
                   WorkerPool& pool, ResultData& data) {
  if (!options.undo_drift) return recipe_drift(options.recipe, z_um[z_um.size() / 2]);
  data.drift_undone = DriftUndone::kNothing;
  data.drift_undone_x_px_per_um = data.drift_undone_y_px_per_um = 0.0;
  if (!*options.undo_drift) return {};
  const auto start = SteadyClock::now();
  SliceFeed look(nullptr, pool, stack, options.allowed_lost_slices, {});
  ResultData books;
  look.run(z_um, books, {});
  DriftPath path = look.drift();
  if (!path.empty()) data.drift_undone = DriftUndone::kSlices;
  data.times.scan_ms += milliseconds_since(start);
  return path;
}

/// From the slices to the maps; twice where the first pass finds the steps so fine that bins are better. The memory of
/// curves and slices is free again when the result is written.
void measure(const ProcessOptions& options, const RecordedStack& stack, SteadyClock::time_point start,
             const std::vector<double>& z_um, Recipe recipe, const std::function<void(int, int)>& on_slice,
             ResultData& data) {
  for (Warning& warning : check_stack(options, z_um)) data.warnings.push_back(std::move(warning));
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  WorkerPool pool(options.threads > 0 ? options.threads : std::max(1, cores));
  const std::vector<Warning> warnings = data.warnings;
  data.times.prepare_ms = milliseconds_since(start);
  const DriftPath drift = drift_of(options, stack, z_um, pool, data);
  auto pass = std::make_unique<Pass>(recipe, stack, options.allowed_lost_slices, drift, pool);
  pass->run(stack, z_um, data, on_slice);
  if (learn_bins(recipe, data)) {
    data.warnings = warnings;
    data.frames = {};
    data.steps.clear();
    data.suspects.clear();
    data.map = {};
    data.focus = focus_settings(recipe);
    pass.reset();  // its memory first
    pass = std::make_unique<Pass>(recipe, stack, options.allowed_lost_slices, drift, pool);
    pass->run(stack, z_um, data, on_slice);
  }
  pass->further(data);
}

}  // namespace

ProcessReport process_stack(const ProcessOptions& options, const std::function<void(int, int)>& on_slice) {
  const auto start = SteadyClock::now();
  check_options(options);
  const RecordedStack stack(options.slices, options.significant_bits);
  ResultData data;
  const std::vector<double> z_um = slice_heights_um(options.z, stack.list());
  const Recipe recipe = recipe_of_slices(options, z_um);
  describe(data, options, recipe, stack);
  measure(options, stack, start, z_um, recipe, on_slice, data);
  data.step_summary = summarize_steps(data.steps);
  return {stack.list().description, files_text(stack.list()), write_result(options.out, data)};
}

}  // namespace fvd::ctl
