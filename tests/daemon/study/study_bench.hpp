#pragma once

/// A desk for studies of jobs whose results are made up: folders as real jobs leave them.

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/base/units.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/result/evaluate.hpp"
#include "daemon/study/study_desk.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

/// Of a point in um.
using HeightAt = std::function<double(int column, int row)>;

/// One value of a measurement "step".
inline Evaluation evaluation_of(double height_um, std::optional<double> u_um, const std::string& calibration = "none") {
  EvaluatedValue value;
  value.value = height_um;
  value.unit = "um";
  if (u_um) {
    value.u = *u_um;
    value.expanded_u = 2.0 * *u_um;
    value.k = 2.0;
  }
  EvaluatedMeasurement step;
  step.kind = "step_height";
  step.surface = "measured";
  step.main_value = "height_um";
  step.values["height_um"] = value;
  EvaluatedValue none;
  none.unit = "um";
  none.reason = "the groove has no edges";
  step.values["depth_um"] = none;
  Evaluation evaluation;
  evaluation.rule = "simple";
  evaluation.calibration = calibration;
  evaluation.order = {"step"};
  evaluation.measurements["step"] = step;
  return evaluation;
}

class AStudyDesk : public testing::Test {
 protected:
  static constexpr int kWidth = 60;
  static constexpr int kHeight = 40;

  /// A job without points of its own: 6 x 3.
  ResultData job_data(const std::string& id) const {
    ResultData data = sample_result();
    data.job_id = id;
    data.recipe_id = "part";
    data.pixel_pitch_x_um = data.pixel_pitch_y_um = 1.0;
    data.exports = std::vector<std::string>{"tiff"};
    return data;
  }
  ResultData surface_data(const std::string& id, const HeightAt& height_um, int width = kWidth,
                          int height = kHeight) const {
    ResultData data = job_data(id);
    data.map = sample_map(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double z_um = height_um(x, y);
        if (std::isnan(z_um)) {
          make_hole(data.map, x, y, mask_reason::kLowProminence);
        } else {
          data.map.height_m.at(x, y) = static_cast<float>(z_um * kMetresPerMicrometer);
        }
      }
    }
    return data;
  }
  /// With its files.
  void keep(const ResultData& data) {
    write_result(scratch_ / data.job_id, data);
    know(data);
  }
  /// Without files: for studies that look at values alone.
  void know(const ResultData& data) {
    StoredJob stored;
    stored.status.job_id = data.job_id;
    stored.status.state = JobState::kCompleted;
    stored.result_dir = (scratch_ / data.job_id).string();
    stored.result_json = result_json_text(evaluate(data, summary_of(data.map)));
    jobs_[data.job_id] = stored;
  }
  void know_value(const std::string& id, double height_um, std::optional<double> u_um,
                  const std::string& calibration = "none") {
    ResultData data = job_data(id);
    data.evaluation = evaluation_of(height_um, u_um, calibration);
    know(data);
  }

  Study make(const std::string& kind, StudyInput input) { return desk_->make({kind, "anna", std::move(input)}, {}); }
  [[nodiscard]] static double figure(const Study& study, const std::string& name) {
    const StudyFigure* const found = study.find(name);
    EXPECT_TRUE(found != nullptr && found->value) << name;
    return found != nullptr ? found->value.value_or(std::nan("")) : std::nan("");
  }
  [[nodiscard]] static bool warns(const Study& study, const std::string& code) {
    for (const StudyWarning& warning : study.warnings) {
      if (warning.code == code) return true;
    }
    return false;
  }
  /// Folders of studies, and what is left of any that came to nothing.
  [[nodiscard]] std::set<std::string> kept() const {
    std::set<std::string> names;
    if (!std::filesystem::exists(scratch_ / "studies")) return names;
    for (const auto& entry : std::filesystem::directory_iterator(scratch_ / "studies")) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }
  [[nodiscard]] StudySources sources(std::size_t memory_bytes = std::size_t{1} << 30U) {
    return StudySources{[this](const std::string& id) {
                          const auto found = jobs_.find(id);
                          if (found == jobs_.end()) throw Error(ErrorCode::kUnknownJob, "no job " + id);
                          return found->second;
                        },
                        [this](const std::string& id) {
                          const auto found = recipes_.find(id);
                          if (found == recipes_.end()) throw Error(ErrorCode::kUnknownRecipe, "no recipe " + id);
                          return parse_recipe(found->second, id);
                        },
                        memory_bytes, calibrations_->folder()};
  }
  void open_desk(bool simulated = true, std::size_t memory_bytes = std::size_t{1} << 30U) {
    desk_.reset();
    calibrations_.emplace(scratch_ / "calibration");
    studies_.emplace(scratch_ / "studies");
    desk_.emplace(sources(memory_bytes), *studies_, *calibrations_, simulated);
  }
  void SetUp() override { open_desk(); }

  ScratchDir scratch_;
  std::map<std::string, StoredJob> jobs_;
  std::map<std::string, std::string> recipes_;
  std::optional<CalibrationBook> calibrations_;
  std::optional<StudyBook> studies_;
  std::optional<StudyDesk> desk_;
};

}  // namespace fvd::test
