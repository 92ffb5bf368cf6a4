#pragma once

/// What jobs left behind, as studies take it.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/result/result.hpp"
#include "daemon/store/job_status.hpp"
#include "daemon/study/study.hpp"
#include "daemon/study/study_requests.hpp"

namespace fvd {

/// Where studies look.
struct StudySources {
  std::function<StoredJob(const std::string& job_id)> job;  ///< throws Error kUnknownJob
  std::function<Recipe(const std::string& id)> recipe;      ///< throws Error kUnknownRecipe, kBadRecipe
  std::size_t memory_budget_bytes = std::size_t{1} << 30U;
  std::filesystem::path calibration_folder = {};  ///< of the reference maps that results name; empty = none is at hand
};

/// How a job's value is taken.
enum class Corrected {
  kAsMeasured,  ///< with the constants that were in force
  kUndone,      ///< heights as the axis gave them: to find the constants anew
};

struct JobValue {
  std::string name;  ///< "step.height_um"
  std::string unit;
  double value = 0.0;
  std::optional<double> u;  ///< standard uncertainty; with kUndone without those of the constants
  double u_common = 0.0;    ///< the part of u that further scans of the same place have too
};

/// The jobs of one study; files are read when they are asked for. context: one thread; sources outlive it.
class StudyJobs {
 public:
  /// alive: called before each piece of work, the longest of which is one job's evaluation; may be empty.
  StudyJobs(const StudySources& sources, std::stop_token stop, std::function<void()> alive = {})
      : sources_(sources), stop_(std::move(stop)), alive_(std::move(alive)) {}

  /// What result.json tells. Throws Error kUnknownJob; kStudyRefused where there is no result; kShuttingDown.
  [[nodiscard]] const Result& result(const std::string& job);

  /// The measured heights, through an S-filter where one is asked for. The result's pitch, or the other where it tells
  /// none. Throws as result(), kSurfaceFile, kStudyRefused, kMemoryBudget before anything is read.
  [[nodiscard]] metrology::HeightField field(const std::string& job, std::optional<double> s_nesting_um = {},
                                             std::optional<double> else_pitch_um = {});

  /// The fields of all, of one size and pitch. Throws Error kStudyRefused where they differ, kMemoryBudget before
  /// anything is read.
  [[nodiscard]] std::vector<metrology::HeightField> fields(const std::vector<std::string>& jobs,
                                                           std::optional<double> s_nesting_um = {});

  /// recipe: empty = the job's own evaluation. Throws Error kStudyRefused with the reason where there is no such value;
  /// kUnknownRecipe, kBadRecipe.
  [[nodiscard]] JobValue value(const std::string& job, const EvaluatedChoice& what, const std::string& recipe,
                               Corrected corrected);

  /// Whether all name the same part.
  [[nodiscard]] bool of_one_part(const std::vector<std::string>& jobs);

  /// Throws Error kCalibrationMissing where the job was evaluated without constants.
  void require_calibration(const std::string& job);

  /// Tells the study its jobs, their objective and recipe, and whether a simulator made one; warns where recipes or
  /// constants differ. evaluated_by: the recipe that they are evaluated anew with. Throws Error kStudyRefused for jobs
  /// of different objectives.
  void note(const std::vector<std::string>& jobs, const std::string& evaluated_by, Study& study);

 private:
  struct Job {
    std::string folder;
    Result result;
    std::optional<Evaluation> evaluation;  ///< made anew with a recipe
  };
  /// Throws Error kShuttingDown.
  void go_on() const;
  [[nodiscard]] Job& job(const std::string& id);
  [[nodiscard]] const Evaluation& evaluation_of(const std::string& id, const std::string& recipe, Corrected corrected);
  void check_memory(const std::vector<std::string>& jobs);

  const StudySources& sources_;
  std::stop_token stop_;
  std::function<void()> alive_;
  std::map<std::string, Job> jobs_;
  std::optional<Recipe> recipe_;
};

/// The points of the rectangle and of the circle; empty = every point. Throws Error kRegionOutside where one leaves the
/// field.
[[nodiscard]] metrology::Region region_of(const StudyRegion& region, const metrology::HeightField& field);

}  // namespace fvd
