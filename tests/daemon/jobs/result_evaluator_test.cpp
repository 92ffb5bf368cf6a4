/// Stored results are evaluated anew beside the machine: records of their own, and the first result as it was.

#include "daemon/jobs/result_evaluator.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "config/field_writer.hpp"
#include "daemon/calibration/calibration_book.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/gsf.hpp"
#include "daemon/jobs/reconcile_results.hpp"
#include "daemon/pipeline/stored_surface.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/surface_files/reference_map.hpp"
#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kTexture = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.5}},
  "evaluation": {"measurements": {"texture": {"kind": "areal", "parameters": ["Sa", "Sq"],
                                              "limits": {"Sa_um": {"upper": 0.8}}}}}})";

/// As result.json has it.
json json_of(Evaluation evaluation) {
  return json::parse(fields_to_json([&](Fields& fields) { describe(evaluation, fields); }).dump());
}

class AStoredResult : public test::AnEngine {
 protected:
  void SetUp() override {
    test::write_text(folder_.path() / "texture.json", kTexture);
    open();
    ASSERT_TRUE(await_state(ScanState::kInitialized));
    job_id_ = jobs().start({1, "a", "part"}).job.job_id;
    ASSERT_TRUE(await_end_of(1));
    // They are made after the job's end, and change what its result tells of them.
    ASSERT_TRUE(await([this](const MachineStatus&) { return store_->with_pending_files().empty(); }));
  }

  [[nodiscard]] ResultService& results() { return services_->results; }
  [[nodiscard]] std::filesystem::path results_dir() const { return folder_.path() / "results"; }

  [[nodiscard]] DeviceTask::Outcome outcome_of(const JobKey& key, const std::string& recipe = "texture") {
    const auto task = results().evaluate(key, recipe);
    EXPECT_TRUE(await_answer(*task));
    return task->outcome().value_or(DeviceTask::Outcome{});
  }

  std::string job_id_;
};

TEST_F(AStoredResult, IsEvaluatedIntoARecordThatNamesItsSource) {
  const DeviceTask::Outcome outcome = outcome_of(ClientSeq{1});
  ASSERT_EQ(outcome.error, std::nullopt) << outcome.message;

  const json reply = json::parse(outcome.json);
  const std::string id = job_id_ + "-e1";
  EXPECT_EQ(reply["id"], id);
  EXPECT_EQ(reply["job_id"], job_id_);
  EXPECT_EQ(reply["recipe"], "texture");
  EXPECT_EQ(reply["directory"], (results_dir() / id).string());
  const StoredJob told = results().stored(id);
  EXPECT_EQ(told.status.job_id, id);
  EXPECT_EQ(told.status.request.recipe, "texture");
  EXPECT_EQ(told.status.request.seq, 1);
  EXPECT_EQ(told.result_json, test::read_text(results_dir() / id / "result.json"));
  EXPECT_TRUE(std::filesystem::exists(results_dir() / id / "report.pdf"));
  const json record = json::parse(told.result_json);
  EXPECT_EQ(record["source"]["job_id"], job_id_);
  EXPECT_EQ(record["source"]["recipe"]["id"], "part");
  EXPECT_EQ(record["recipe"]["sha256"], recipe_sha256(kTexture));
  EXPECT_EQ(record["verdict"], reply["verdict"]);
}

TEST_F(AStoredResult, HasTheValuesOfTheSameEvaluationOfItsFolder) {
  const json reply = json::parse(outcome_of(job_id_).json);

  const StoredSurface stored = read_stored_surface(results_dir() / job_id_);
  const Recipe recipe = parse_recipe(kTexture, "texture");
  const Evaluation same = evaluate_surface(stored.surface, recipe.evaluation, stored.context, nullptr);
  const json record = json::parse(results().stored(reply["id"].get<std::string>()).result_json);
  EXPECT_EQ(record["evaluation"], json_of(same));
}

TEST_F(AStoredResult, StaysAsItWasHoweverOftenItIsEvaluated) {
  const StoredJob before = results().stored(ClientSeq{1});
  const std::string file = test::read_text(results_dir() / job_id_ / "result.json");

  const json first = json::parse(outcome_of(job_id_).json);
  const json second = json::parse(outcome_of(job_id_).json);

  EXPECT_EQ(first["id"], job_id_ + "-e1");
  EXPECT_EQ(second["id"], job_id_ + "-e2");
  EXPECT_EQ(results().stored(ClientSeq{1}).result_json, before.result_json);
  EXPECT_EQ(results().stored(job_id_).result_dir, before.result_dir);
  EXPECT_EQ(test::read_text(results_dir() / job_id_ / "result.json"), file);
  EXPECT_EQ(machine().snapshot()->job->job_id, job_id_);
}

TEST_F(AStoredResult, IsNotEvaluatedAnyMoreOnceItWasRemoved) {
  (void)results().acknowledge(ClientSeq{1});
  ASSERT_TRUE(store_->results().mark_removed(job_id_));
  FVD_EXPECT_ERROR_SAYING(kResultRemoved, (void)results().evaluate(ClientSeq{1}, "texture"),
                          HasSubstr("was removed at"));
}

TEST_F(AStoredResult, PassesOverAFolderThatADeadProcessLeft) {
  std::filesystem::create_directories(results_dir() / (job_id_ + "-e1"));

  EXPECT_EQ(json::parse(outcome_of(job_id_).json)["id"], job_id_ + "-e2");
}

TEST_F(AStoredResult, LeavesNoFolderOfARecordThatTheDatabaseRefuses) {
  StoredEvaluation other;
  other.id = job_id_ + "-e1";
  other.job_id = "another";
  other.number = 1;
  store_->evaluations().add(other);

  EXPECT_EQ(outcome_of(job_id_).error, ErrorCode::kDatabase);
  const std::string hidden = refused_evaluation(job_id_ + "-e1");
  for (const auto& entry : std::filesystem::directory_iterator(results_dir())) {
    EXPECT_THAT(entry.path().filename().string(), ::testing::AnyOf(job_id_, hidden));
  }
  EXPECT_TRUE(std::filesystem::exists(results_dir() / hidden / "result.json")) << "whole, should its row come back";
}

TEST_F(AStoredResult, IsKeptWithItsRecordsOverARestart) {
  const json reply = json::parse(outcome_of(job_id_).json);
  engine_->finish();
  machine().on_change({});
  services_.reset();
  engine_.reset();
  store_.reset();

  JobStore again(folder_.path() / "fvd.sqlite");
  const auto row = again.evaluations().find(reply["id"].get<std::string>());
  ASSERT_TRUE(row.has_value());
  EXPECT_EQ(row->job_id, job_id_);
  EXPECT_EQ(row->recipe, "texture");
}

TEST_F(AStoredResult, IsNotEvaluatedByWhatCannotDoIt) {
  FVD_EXPECT_ERROR(kUnknownJob, static_cast<void>(results().evaluate("nothing", "texture")));
  FVD_EXPECT_ERROR(kUnknownRecipe, static_cast<void>(results().evaluate(job_id_, "nothing")));
  FVD_EXPECT_ERROR(kBadRecipe, static_cast<void>(results().evaluate(job_id_, "part")));  // measures nothing
  const std::string id = json::parse(outcome_of(job_id_).json)["id"];
  FVD_EXPECT_ERROR(kBadInput, static_cast<void>(results().evaluate(id, "texture")));
  FVD_EXPECT_ERROR(kUnknownJob, results().acknowledge(id));
}

TEST_F(AStoredResult, IsRefusedWhereItsFilesAreGone) {
  std::filesystem::remove(results_dir() / job_id_ / "height.tiff");
  std::filesystem::remove(results_dir() / job_id_ / "height.gsf");

  const DeviceTask::Outcome outcome = outcome_of(job_id_);

  EXPECT_EQ(outcome.error, ErrorCode::kSurfaceFile);
  EXPECT_THAT(outcome.message, HasSubstr(job_id_));
  EXPECT_FALSE(std::filesystem::exists(results_dir() / (job_id_ + "-e1")));
  FVD_EXPECT_ERROR(kUnknownJob, static_cast<void>(results().stored(job_id_ + "-e1")));
}

TEST_F(AStoredResult, IsNotEvaluatedWhereTheJobHasNone) {
  StoredJob none;
  none.status.job_id = "j";
  none.status.state = JobState::kAborted;
  ResultEvaluator evaluator(
      {*store_, dynamic_cast<MachineBoard&>(machine()), results_dir(), {}, std::size_t{1} << 30U});

  FVD_EXPECT_ERROR(kBadInput, static_cast<void>(evaluator.begin(none, parse_recipe(kTexture, "texture"))));
  none.status.state = JobState::kProcessing;
  FVD_EXPECT_ERROR(kBusy, static_cast<void>(evaluator.begin(none, parse_recipe(kTexture, "texture"))));
  evaluator.finish();
  FVD_EXPECT_ERROR(kShuttingDown,
                   static_cast<void>(evaluator.begin(results().stored(job_id_), parse_recipe(kTexture, "texture"))));
}

TEST_F(AStoredResult, IsNotEvaluatedBeyondTheMemoryBudget) {
  ResultEvaluator evaluator({*store_, dynamic_cast<MachineBoard&>(machine()), results_dir(), {}, 1000});

  std::string message;
  try {
    static_cast<void>(evaluator.begin(results().stored(job_id_), parse_recipe(kTexture, "texture")));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMemoryBudget);
    message = error.what();
  }

  EXPECT_THAT(message, HasSubstr("16 x 16 points"));
}

constexpr const char* kFlattened = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.5}},
  "evaluation": {"surfaces": {"s": {"steps": [{"op": "flatness_reference"}]}},
                 "measurements": {"texture": {"kind": "areal", "surface": "s", "parameters": ["Sa", "Sq"]}}}})";

/// An instrument with a reference map of the size of its frames.
class AFlattenedResult : public AStoredResult {
 protected:
  void SetUp() override {
    CalibrationBook(calibration_dir()).add("", [](Calibration& next) {
      next.flatness = FlatnessConstants{0.1, 0.01, next.id + "-flatness.gsf", {}};
      Plane<float> metres(16, 16);
      for (int i = 0; i < 16; ++i) metres.at(i, i) = 3e-6F;
      return std::vector<CalibrationFile>{{next.flatness->reference, encode_gsf(metres, {"flat", 0.5, 0.5, {}})}};
    });
    test::write_text(folder_.path() / "part.json", R"({"scan": {"start_um": 0, "step_um": 10, "slices": 5},
      "lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.5}})");
    test::write_text(folder_.path() / "flattened.json", kFlattened);
    AStoredResult::SetUp();
  }
  [[nodiscard]] std::filesystem::path calibration_dir() const { return folder_.path() / "calibration"; }
};

TEST_F(AFlattenedResult, IsEvaluatedWithTheReferenceMapThatItNames) {
  StoredSurface stored = read_stored_surface(results_dir() / job_id_);
  const Recipe recipe = parse_recipe(kFlattened, "flattened");
  const json without = json_of(evaluate_surface(stored.surface, recipe.evaluation, stored.context, nullptr));
  stored.context.flatness_reference = read_reference_map(calibration_dir(), "cal-0001-flatness.gsf");
  const json with = json_of(evaluate_surface(stored.surface, recipe.evaluation, stored.context, nullptr));

  const DeviceTask::Outcome outcome = outcome_of(job_id_, "flattened");

  ASSERT_EQ(outcome.error, std::nullopt) << outcome.message;
  const std::string id = json::parse(outcome.json)["id"];
  EXPECT_EQ(json::parse(results().stored(id).result_json)["evaluation"], with);
  EXPECT_NE(with, without);
}

TEST_F(AFlattenedResult, IsRefusedWhereTheMapIsGone) {
  std::filesystem::remove(calibration_dir() / "cal-0001-flatness.gsf");

  const DeviceTask::Outcome outcome = outcome_of(job_id_, "flattened");

  EXPECT_EQ(outcome.error, ErrorCode::kSurfaceFile);
  EXPECT_THAT(outcome.message, HasSubstr("cal-0001-flatness.gsf"));
  EXPECT_FALSE(std::filesystem::exists(results_dir() / (job_id_ + "-e1")));
}

}  // namespace
}  // namespace fvd
