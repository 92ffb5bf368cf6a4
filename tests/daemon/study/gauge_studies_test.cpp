/// Gauge studies, and the repeatability that evaluations take from them.

#include <gmock/gmock.h>

#include "tests/daemon/study/study_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

class AGauge : public test::AStudyDesk {
 protected:
  /// 25 x 50.1 and 25 x 49.9.
  Type1Request fifty_scans() {
    Type1Request request;
    for (int i = 0; i < 50; ++i) {
      request.jobs.push_back("t" + std::to_string(i));
      know_value(request.jobs.back(), i < 25 ? 50.1 : 49.9, 0.01);
    }
    request.what.measurement = "step";
    request.reference = 50.0;
    request.tolerance = 4.0;
    return request;
  }
  /// Parts 0, 1, 2; operators +0, +0.2; trials +-0.1.
  RrRequest crossed_scans() {
    RrRequest request;
    request.parts = 3;
    request.operators = 2;
    request.trials = 2;
    request.what = {"step", "height_um"};
    for (int i = 0; i < 12; ++i) {
      request.jobs.push_back("x" + std::to_string(i));
      ResultData data = job_data(request.jobs.back());
      data.part_id = "part-" + std::to_string(i / 4);
      data.evaluation = test::evaluation_of(i / 4 + 0.2 * (i / 2 % 2) + (i % 2 == 0 ? 0.1 : -0.1), 0.01);
      know(data);
    }
    return request;
  }
};

TEST_F(AGauge, IsJudgedByOnePart) {
  const Study study = make("gauge.type1", fifty_scans());

  EXPECT_NEAR(figure(study, "sd"), 0.1010153, 1e-7);
  EXPECT_NEAR(figure(study, "Cg"), 1.319933, 1e-6);
  EXPECT_NEAR(figure(study, "Cgk"), 1.319933, 1e-6);
  EXPECT_EQ(figure(study, "capable"), 0.0);
  EXPECT_TRUE(warns(study, "not_capable"));
  EXPECT_FALSE(warns(study, "few_scans"));
  EXPECT_FALSE(study.find("resolution_percent")->value);
  EXPECT_EQ(study.values.front().name, "step.height_um") << "the main value, where none is named";
  EXPECT_NEAR(study.values.front().deviation.value(), 0.1, 1e-9);
}

TEST_F(AGauge, IsJudgedByFewScansWithAWarning) {
  Type1Request request = fifty_scans();
  request.jobs.resize(24);

  EXPECT_TRUE(warns(make("gauge.type1", request), "few_scans"));
  request.jobs.resize(1);
  FVD_EXPECT_ERROR(kStudyRefused, make("gauge.type1", request));
  request.jobs.clear();
  FVD_EXPECT_ERROR(kStudyRefused, make("gauge.type1", request));
}

TEST_F(AGauge, WithoutSpreadHasNoCapabilityAndSaysWhy) {
  Type1Request request = fifty_scans();
  request.jobs.resize(25);

  const Study study = make("gauge.type1", request);

  EXPECT_FALSE(study.find("Cg")->value);
  EXPECT_EQ(study.find("Cg")->reason, "the values do not differ");
}

TEST_F(AGauge, IsJudgedByPartsOperatorsAndTrials) {
  const Study study = make("gauge.rr", crossed_scans());

  EXPECT_NEAR(figure(study, "EV"), 0.1224745, 1e-7);
  EXPECT_NEAR(figure(study, "AV"), 0.1322876, 1e-7);
  EXPECT_NEAR(figure(study, "GRR"), 0.1802776, 1e-7);
  EXPECT_NEAR(figure(study, "PV"), 0.9981233, 1e-7);
  EXPECT_NEAR(figure(study, "grr_of_total_percent"), 17.774, 1e-3);
  EXPECT_EQ(figure(study, "ndc"), 7.0);
  EXPECT_EQ(figure(study, "interaction_pooled"), 1.0);
  EXPECT_TRUE(warns(study, "conditionally_capable"));
  EXPECT_FALSE(warns(study, "order"));
}

TEST_F(AGauge, NoticesJobsInAnotherOrder) {
  RrRequest request = crossed_scans();
  std::swap(request.jobs[0], request.jobs[11]);

  EXPECT_TRUE(warns(make("gauge.rr", request), "order"));
  request.jobs.pop_back();
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("gauge.rr", request), HasSubstr("are 12"));
}

TEST_F(AGauge, IsJudgedByBothStudies) {
  const Study type1 = make("gauge.type1", fifty_scans());
  const Study rr = make("gauge.rr", crossed_scans());
  CapabilityRequest request;
  request.type1 = type1.id;
  request.rr = rr.id;
  request.u_calibration = 0.05;

  const Study study = make("gauge.capability", request);

  // u_MS^2 = CAL^2 + EVR^2; u_MP^2 = CAL^2 + EVO^2 + AV^2, EVO above EVR.
  const double u_system = std::hypot(0.05, 0.1010153);
  const double u_process = std::sqrt(0.05 * 0.05 + 0.1224745 * 0.1224745 + 0.1322876 * 0.1322876);
  EXPECT_NEAR(figure(study, "Q_MS_percent"), 100.0 * 4.0 * u_system / 4.0, 1e-4);
  EXPECT_NEAR(figure(study, "Q_MP_percent"), 100.0 * 4.0 * u_process / 4.0, 1e-4);
  EXPECT_TRUE(study.jobs.empty());
  EXPECT_TRUE(study.simulated);
  request.rr = type1.id;
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("gauge.capability", request), HasSubstr("not gauge.rr"));
  request.rr = "study-0100";
  FVD_EXPECT_ERROR(kStudyRefused, make("gauge.capability", request));
}

TEST_F(AGauge, TellsEvaluationsItsRepeatability) {
  EXPECT_TRUE(studies_->newest_repeatability("part", "", true).empty());
  (void)make("gauge.type1", fifty_scans());
  const auto first = studies_->newest_repeatability("part", "", true);
  ASSERT_TRUE(first.contains("step.height_um"));
  EXPECT_NEAR(first.at("step.height_um").sd, 0.1010153, 1e-7);
  EXPECT_EQ(first.at("step.height_um").dof, 49.0);

  (void)make("gauge.rr", crossed_scans());
  open_desk();

  const auto newest = studies_->newest_repeatability("part", "", true);
  EXPECT_EQ(newest.size(), 1U);
  EXPECT_EQ(newest.at("step.height_um").study, "study-0002");
  EXPECT_NEAR(newest.at("step.height_um").sd, 0.1224745, 1e-7);
  EXPECT_EQ(newest.at("step.height_um").dof, 8.0) << "6 of the trials and 2 of the pooled interaction";
  EXPECT_TRUE(studies_->newest_repeatability("another", "", true).empty());
  EXPECT_TRUE(studies_->newest_repeatability("", "", true).empty());
}

TEST_F(AGauge, TellsNothingOfAnotherObjectiveOrOfAnInstrumentThatIsNoSimulator) {
  (void)make("gauge.type1", fifty_scans());

  EXPECT_FALSE(studies_->newest_repeatability("part", "", true).empty());
  EXPECT_TRUE(studies_->newest_repeatability("part", "50x", true).empty());
  EXPECT_TRUE(studies_->newest_repeatability("part", "", false).empty());
}

TEST_F(AGauge, EvaluatesSurfacesAnewWithARecipe) {
  recipes_["mean"] = R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
    "reconstruct": {"lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}},
    "evaluation": {"measurements": {"all": {"kind": "areal", "parameters": ["Sz"]}}}})";
  Type1Request request;
  for (int i = 0; i < 3; ++i) {
    request.jobs.push_back("s" + std::to_string(i));
    keep(surface_data(request.jobs.back(), [i](int x, int) { return x % 5 == 0 ? 1.0 + 0.25 * i : 0.0; }));
  }
  request.what = {"all", "Sz_um"};
  request.reference = 1.25;
  request.tolerance = 2.0;
  request.recipe = "mean";

  int pieces = 0;
  const Study study = desk_->make({"gauge.type1", "anna", request}, {}, [&pieces] { ++pieces; });

  EXPECT_EQ(pieces, 6) << "each job is read and evaluated: hundreds of them take longer than one may";
  EXPECT_NEAR(figure(study, "mean"), 1.25, 1e-6);
  EXPECT_NEAR(figure(study, "sd"), 0.25, 1e-6);
  EXPECT_EQ(study.recipe_id, "mean");
  EXPECT_EQ(study.recipe_sha256, recipe_sha256(recipes_["mean"]));
  open_desk(true, 1U << 10U);
  FVD_EXPECT_ERROR(kMemoryBudget, make("gauge.type1", request));
  open_desk();
  request.recipe = "nowhere";
  FVD_EXPECT_ERROR(kUnknownRecipe, make("gauge.type1", request));
}

TEST_F(AGauge, IsReadWhileTheNextOneIsKept) {
  const Study first = make("gauge.type1", fifty_scans());

  (void)studies_->keep(StudyDraft{}, [this, &first](const Study&) {
    EXPECT_EQ(studies_->list(), std::vector<Study>{first});  // a job that begins meanwhile looks for its repeatability
    return std::string("report");
  });

  EXPECT_EQ(studies_->list().size(), 2U);
}

TEST_F(AGauge, IsThereAfterARestartHoweverManyJobsItHas) {
  StudyDraft draft;
  draft.study.kind = "gauge.rr";
  for (int i = 0; i < 9000; ++i)
    draft.study.values.push_back({std::string(60, 'j') + std::to_string(i), "step.height_um", 50.0, {}, {}, {}});
  const Study kept = studies_->keep(std::move(draft), [](const Study&) { return std::string("report"); });
  ASSERT_GT(std::filesystem::file_size(studies_->folder_of(kept.id) / "study.json"), std::uintmax_t{1} << 20U);

  open_desk();

  EXPECT_EQ(studies_->get(kept.id), kept);
}

TEST_F(AGauge, GivesTheSameReportForTheSameStudy) {
  const Study study = make("gauge.type1", fifty_scans());
  const std::string pdf = test::read_text(studies_->folder_of(study.id) / "report.pdf");

  EXPECT_GT(pdf.size(), 3000U);
  EXPECT_EQ(pdf.find("/Image"), std::string::npos) << "points and words are vectors";
}

}  // namespace
}  // namespace fvd
