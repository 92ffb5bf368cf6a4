#pragma once

/// From the slices that a stack has seen to the surfaces of a recipe: the same for a live scan and for recorded slices.

#include <vector>

#include "core/focus/drift_undo.hpp"
#include "core/focus/judge/suspect_slice.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

/// Notes of the recipe what its result tells: id, digest, settings, scale, what it asks for.
void note_recipe(const Recipe& recipe, ResultData& data);

/// Notes what the judging of the slices found, in the order of the scan. left_out: added to those of data.
void note_light(const std::vector<SuspectSlice>& left_out, double flicker_percent, ResultData& data);

/// Notes the drift of the slices as they came, and what undoing it hid.
void note_drift(const DriftMeter& drift, const HiddenBorder& hidden, ResultData& data);

/// What the recipe undoes; empty where it does not. middle_um: z of the slice that stays where it is.
[[nodiscard]] DriftPath recipe_drift(const Recipe& recipe, double middle_um);

/// What the bins follow from. context: pure.
[[nodiscard]] BinChoice bin_choice(const Recipe& recipe);

/// The largest bins that cost hardly any of the heights that were found: a bin of n slices begins to see peaks n - 1/2
/// steps within the range. height_m: NaN in holes. step_um: > 0. context: pure.
[[nodiscard]] int most_bin_slices(const Plane<float>& height_m, const StepLog& steps, double step_um);

/// Heights by recipe.peak; a warning where the curves turn out so wide against the step that bins would have made less
/// error, and nothing had told their width before. Throws Error kBadSlice without slices, as the next.
void reconstruct(const StreamingFocusStack& stack, const Recipe& recipe, ResultData& data);

/// The smoothed map where the recipe asks for it, and heights by each of recipe.extra_peaks, once.
void reconstruct_further(const StreamingFocusStack& stack, const Recipe& recipe, WorkerPool& pool, ResultData& data);

/// The measurements of the recipe's section evaluation, on data.map; nothing where it has none. Writes data.evaluation
/// and data.times.evaluate_ms alone. pages: as for evaluate_surface().
void evaluate_as_asked(const Recipe& recipe, WorkerPool& pool, ResultData& data, const KeptPagesPtr& pages = nullptr);

}  // namespace fvd
