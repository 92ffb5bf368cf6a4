/// Steps of known height, and what becomes of the constants they propose.

#include <random>

#include <gmock/gmock.h>

#include "tests/daemon/study/study_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using test::AStudyDesk;
using testing::HasSubstr;

constexpr const char* kToday = "2026-11-29";

RequestedStep step_of(const std::string& job, double reference_um, double u_um = 0.01) {
  return {job, {"step", "height_um"}, reference_um, u_um};
}

class AStepStudy : public AStudyDesk {
 protected:
  /// Steps of 10, 50 and 100 um seen larger by alpha_z.
  StepRequest three_steps(double alpha_z, const std::string& calibration = "none") {
    StepRequest request;
    for (const double reference_um : {10.0, 50.0, 100.0}) {
      const std::string id = "s" + std::to_string(static_cast<int>(reference_um));
      know_value(id, alpha_z * reference_um, 0.02, calibration);
      request.steps.push_back(step_of(id, reference_um));
    }
    return request;
  }
  AcceptRequest acceptance(const std::string& study) const { return {study, "anna", "DKD-4711", "2027-11-29", {}}; }
};

TEST_F(AStepStudy, ProposesTheAmplificationWithItsUncertainty) {
  const Study study = make("calibrate.z", three_steps(1.004));

  // All weights alike: u = s / sqrt(sum of squared references).
  const double u = std::hypot(0.01, 0.02) / std::sqrt(10.0 * 10.0 + 50.0 * 50.0 + 100.0 * 100.0);
  EXPECT_NEAR(figure(study, "alpha_z"), 1.004, 1e-4);
  EXPECT_NEAR(study.find("alpha_z")->u.value(), u, 0.01 * u);
  EXPECT_NEAR(study.find("alpha_z")->k.value(), 1.96, 0.001);
  EXPECT_NEAR(figure(study, "linearity_um"), 0.0, 2e-4);
  ASSERT_TRUE(study.proposal && study.proposal->z);
  EXPECT_EQ(study.proposal->z->alpha_z, figure(study, "alpha_z"));
  EXPECT_EQ(study.values.size(), 3U);
  EXPECT_EQ(study.values[1].reference, 50.0);
}

TEST_F(AStepStudy, OnlyVerifiesWhereItIsAskedTo) {
  const Study study = make("verify.step", three_steps(1.004));

  EXPECT_FALSE(study.proposal);
  EXPECT_TRUE(warns(study, "alpha_z_off"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, desk_->accept(acceptance(study.id), kToday), HasSubstr("verify.step"));
  EXPECT_TRUE(calibrations_->versions().empty());
}

TEST_F(AStepStudy, TakesScansOfOneArtefactAsOne) {
  StepRequest request;
  for (int i = 0; i < 4; ++i) {
    const std::string id = "r" + std::to_string(i);
    know_value(id, 50.0 + 0.1 * (i % 2 == 0 ? 1.0 : -1.0), 0.01);
    request.steps.push_back(step_of(id, 50.0, 0.03));
  }

  const Study study = make("calibrate.z", request);

  // The scatter, sd 0.11547, is larger than the budgets tell; the certificate's 0.03 does not average.
  const double u_mean_um = std::sqrt(4.0 * 0.01 / 3.0) / 2.0;
  EXPECT_NEAR(study.find("alpha_z")->u.value(), std::hypot(0.03, u_mean_um) / 50.0, 1e-9);
  EXPECT_EQ(figure(study, "artefacts"), 1.0);
  EXPECT_EQ(figure(study, "scans"), 4.0);
  EXPECT_TRUE(warns(study, "one_step"));
  EXPECT_EQ(study.proposal->z->linearity_um, 0.0) << "not known";
}

TEST_F(AStepStudy, DoesNotAverageWhatAllScansShare) {
  StepRequest request;
  for (int i = 0; i < 4; ++i) {
    ResultData data = job_data("c" + std::to_string(i));
    data.evaluation = test::evaluation_of(50.0, 0.05);
    data.evaluation->measurements["step"].values["height_um"].budget = {
        {.source = "noise", .type = "A", .u = 0.02, .dof = {}, .points_as_one = {}},
        {.source = "slice_z", .type = "B", .u = 0.02, .dof = {}, .points_as_one = {}},
        {.source = "flatness", .type = "B", .u = std::sqrt(0.0017), .dof = {}, .points_as_one = {}},
        {.source = "alpha_z", .type = "B", .u = 9.0, .dof = {}, .points_as_one = {}}};
    know(data);
    request.steps.push_back(step_of(data.job_id, 50.0, 0.0));
  }

  const Study study = make("calibrate.z", request);

  EXPECT_NEAR(study.find("alpha_z")->u.value(), std::sqrt(0.0008 / 4.0 + 0.0017) / 50.0, 1e-9);
}

TEST_F(AStepStudy, AddsWhatTheCertificatesShare) {
  StepRequest request = three_steps(1.0);
  const double u_alone = make("calibrate.z", request).find("alpha_z")->u.value();
  request.u_common_relative = 0.001;

  const double u = make("calibrate.z", request).find("alpha_z")->u.value();

  EXPECT_NEAR(u, std::hypot(u_alone, 0.001), 1e-6);
}

TEST_F(AStepStudy, WarnsOfResidualsThatNobodyExplains) {
  StepRequest request = three_steps(1.0);
  know_value("odd", 25.4, 0.02);
  request.steps.push_back(step_of("odd", 25.0));

  EXPECT_TRUE(warns(make("calibrate.z", request), "residuals_unexplained"));
}

TEST_F(AStepStudy, RefusesWhatIsNoStep) {
  StepRequest request = three_steps(1.0);
  const auto refused = [&](const RequestedStep& step) {
    StepRequest changed = request;
    changed.steps.push_back(step);
    return changed;
  };
  RequestedStep step = step_of("s10", 10.0);

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.z", refused(step)), HasSubstr("twice"));
  know_value("t", 10.0, 0.01);
  step.job = "t";
  step.what.measurement = "groove";
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.z", refused(step)), HasSubstr("but step"));
  step.what = {"step", "width_um"};
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.z", refused(step)), HasSubstr("depth_um, height_um"));
  step.what = {"step", "depth_um"};
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.z", refused(step)), HasSubstr("no edges"));
  know(job_data("bare"));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.z", refused(step_of("bare", 10.0))),
                          HasSubstr("evaluated nothing"));
  FVD_EXPECT_ERROR(kUnknownJob, make("calibrate.z", refused(step_of("nobody", 10.0))));
  step = step_of("t", std::nan(""));
  FVD_EXPECT_ERROR(kBadInput, make("calibrate.z", refused(step)));
  know_value("bent", 30.0, 0.02);
  request.steps = {step_of("bent", 10.0)};
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.z", request), HasSubstr("alpha_z"));
  EXPECT_TRUE(kept().empty());
}

TEST_F(AStepStudy, AsksForConstantsWhereTheyAreWanted) {
  StepRequest request = three_steps(1.0);
  request.require_calibration = true;

  FVD_EXPECT_ERROR_SAYING(kCalibrationMissing, make("verify.step", request), HasSubstr("s10"));
}

TEST_F(AStepStudy, DoesNotGuessWhatCorrectedAValue) {
  const StepRequest request = three_steps(1.0, "cal-0007");

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, make("calibrate.z", request), HasSubstr("cal-0007"));
  EXPECT_NEAR(figure(make("verify.step", request), "alpha_z"), 1.0, 1e-6);
}

TEST_F(AStepStudy, AcceptsAProposalOnce) {
  const Study study = make("calibrate.z", three_steps(1.004));

  const AcceptedConstants first = desk_->accept(acceptance(study.id), kToday);
  const AcceptedConstants again = desk_->accept(acceptance(study.id), kToday);

  EXPECT_FALSE(first.already);
  EXPECT_TRUE(again.already);
  EXPECT_EQ(again.calibration, first.calibration);
  EXPECT_EQ(first.calibration.id, "cal-0001");
  const ZConstants& z = first.calibration.z.value();
  EXPECT_NEAR(z.alpha_z, 1.004, 1e-4);
  EXPECT_EQ(z.origin.study, study.id);
  EXPECT_EQ(z.origin.person, "anna");
  EXPECT_EQ(z.origin.certificate, "DKD-4711");
  EXPECT_EQ(z.origin.renew_by, "2027-11-29");
  EXPECT_EQ(z.origin.accepted, first.calibration.created);
  EXPECT_EQ(calibrations_->versions().size(), 1U);
  const Study later = make("calibrate.z", three_steps(1.005));
  EXPECT_EQ(desk_->accept(acceptance(later.id), kToday).calibration.id, "cal-0002");
  EXPECT_EQ(desk_->accept(acceptance(study.id), kToday).calibration.id, "cal-0001");
}

TEST_F(AStepStudy, RefusesAnAcceptanceThatIsNone) {
  const Study study = make("calibrate.z", three_steps(1.004));
  const auto accept = [&](auto change) {
    AcceptRequest request = acceptance(study.id);
    change(request);
    return desk_->accept(request, kToday);
  };

  for (const char* date : {"", "2027-02-29", "2027-13-01", "27-11-29", "2027/11/29", "2027-11-2x"}) {
    FVD_EXPECT_ERROR_SAYING(kBadInput, accept([&](AcceptRequest& r) { r.renew_by = date; }), HasSubstr("no date"));
  }
  FVD_EXPECT_ERROR_SAYING(kBadInput, accept([](AcceptRequest& r) { r.renew_by = "2026-11-28"; }), HasSubstr("past"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, accept([](AcceptRequest& r) { r.person = " "; }), HasSubstr("person"));
  FVD_EXPECT_ERROR(kBadInput, accept([](AcceptRequest& r) { r.person = "a\nb"; }));
  FVD_EXPECT_ERROR(kObjectiveMismatch, accept([](AcceptRequest& r) { r.objective = "50x"; }));
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, accept([](AcceptRequest& r) { r.study = "study-0099"; }),
                          HasSubstr("no study"));
  FVD_EXPECT_ERROR(kStudyRefused, accept([](AcceptRequest& r) { r.study = "../study-0001"; }));
  EXPECT_TRUE(calibrations_->versions().empty());
  EXPECT_EQ(accept([](AcceptRequest& r) { r.renew_by = kToday; }).calibration.id, "cal-0001");
}

TEST_F(AStepStudy, KeepsConstantsOfASimulatorFromTheInstrument) {
  const Study study = make("calibrate.z", three_steps(1.004));
  open_desk(false);

  FVD_EXPECT_ERROR_SAYING(kStudyRefused, desk_->accept(acceptance(study.id), kToday), HasSubstr("simulated"));
}

TEST_F(AStepStudy, OfTheInstrumentReplacesConstantsOfASimulator) {
  (void)desk_->accept(acceptance(make("calibrate.z", three_steps(1.004)).id), kToday);
  ASSERT_TRUE(calibrations_->current("")->z->origin.simulated);
  open_desk(false);
  NoiseRequest request;
  for (int i = 0; i < 2; ++i) {
    ResultData data = surface_data("n" + std::to_string(i), [i](int x, int y) { return (x * 7 + y * 3) % (11 + i); });
    data.simulated = false;
    keep(data);
    request.jobs.push_back(data.job_id);
  }

  const Calibration next = desk_->accept(acceptance(make("calibrate.noise", request).id), kToday).calibration;

  EXPECT_FALSE(next.noise->origin.simulated);
  EXPECT_FALSE(next.z);
}

TEST_F(AStepStudy, KeepsTheNumberOfAStudyThatCannotBeRead) {
  const Study study = make("calibrate.z", three_steps(1.004));
  test::write_text(studies_->folder_of(study.id) / "study.json", "{\"format\": 1");
  open_desk();

  ASSERT_EQ(studies_->broken().size(), 1U);
  EXPECT_EQ(studies_->broken()[0].id, study.id);
  FVD_EXPECT_ERROR_SAYING(kStudyRefused, (void)studies_->get(study.id), HasSubstr("cannot be read"));
  EXPECT_EQ(make("calibrate.z", three_steps(1.004)).id, "study-0002");
}

TEST_F(AStepStudy, FindsTheLinearityOverTheRange) {
  LinearityRequest request;
  for (int i = 0; i < 3; ++i) {
    const std::string id = "z" + std::to_string(i);
    know_value(id, 50.0 + 0.1 * i, 0.02);
    request.steps.push_back({id, {"step", "height_um"}, 100.0 * i});
  }

  const Study study = make("verify.linearity", request);

  EXPECT_NEAR(figure(study, "linearity_um"), 0.1, 1e-9);
  EXPECT_NEAR(figure(study, "trend_um_per_mm"), 1.0, 1e-9);
  EXPECT_NEAR(figure(study, "mean_um"), 50.1, 1e-9);
  EXPECT_NEAR(study.find("mean_um")->k.value(), 4.3027, 1e-3);  // t for 2 degrees of freedom
  for (RequestedStepAtZ& step : request.steps) step.z_um = 5.0;
  FVD_EXPECT_ERROR(kStudyRefused, make("verify.linearity", request));
}

/// Demanded: of 20 calibrations with a planted alpha_z the truth within U at least 17 times. Errors drawn of the values
/// and of the certificates.
TEST_F(AStepStudy, HoldsThePlantedAmplificationWithinU) {
  constexpr double kAlpha = 1.0037;
  std::mt19937 engine(4711);
  std::normal_distribution<double> normal;
  int within = 0;
  for (int run = 0; run < 20; ++run) {
    StepRequest request;
    for (const double certificate_um : {10.0, 50.0, 100.0}) {
      const double true_um = certificate_um + 0.02 * normal(engine);
      for (int scan = 0; scan < 2; ++scan) {
        const std::string id = "r" + std::to_string(run) + "_" + std::to_string(static_cast<int>(certificate_um)) +
                               "_" + std::to_string(scan);
        know_value(id, kAlpha * true_um + 0.024 * normal(engine), 0.024);
        request.steps.push_back(step_of(id, certificate_um, 0.02));
      }
    }
    const Study study = make("calibrate.z", request);
    const StudyFigure& alpha = *study.find("alpha_z");
    within += std::abs(alpha.value.value() - kAlpha) <= alpha.expanded_u.value() ? 1 : 0;
  }
  RecordProperty("alpha_z_within_U_of_20", within);
  EXPECT_GE(within, 17);
}

}  // namespace
}  // namespace fvd
