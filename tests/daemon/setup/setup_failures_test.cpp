/// Drives that lose their reference and lines that fail in the middle of a setup: it stays at its question, and nothing
/// that was decided is lost.

#include "daemon/config/config_file.hpp"
#include "daemon/setup/setup_bench.hpp"
#include "tests/daemon/setup/a_setup.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

/// Its drive does not say whether it has a reference: opened anew it has none.
class ASetupOfAForgetfulDrive : public ASetup {
 protected:
  ASetupOfAForgetfulDrive() : ASetup(built(), FVD_SOURCE_DIR "/config/drives/nanotec-cia402.json") {}

 private:
  static sim::PlantOptions built() {
    sim::PlantOptions options = test::letter_f_station({});
    options.drive = sim::DriveKind::kCia402;
    return options;
  }
};

TEST_F(ASetupOfAForgetfulDrive, TeachesBothLimitsByMoves) {
  come_to("lower_limit");
  answer("down 20");
  EXPECT_EQ(step(), "lower_limit");
  EXPECT_NE(note().find("the axis stands at"), std::string::npos) << note();
  answer("down 200");
  answer("here");
  EXPECT_EQ(step(), "exposure") << note();
}

TEST_F(ASetupOfAForgetfulDrive, AsksForTheReferenceWhereItIsNeededAndComesBack) {
  come_to("focus");
  answer("down 10");
  EXPECT_EQ(step(), "reference") << "with the limits in force the drive was opened anew";
  answer("back");
  EXPECT_EQ(step(), "focus");
  answer("picture");
  answer("ok");
  EXPECT_EQ(step(), "reference") << "a place without a reference is none";
  expect_refused("keep", "has no reference");
  answer("home");
  EXPECT_EQ(step(), "focus");
  answer("up 10");
  EXPECT_NE(note().find("the axis stands at"), std::string::npos) << note();
  answer("back");
  EXPECT_EQ(step(), "exposure") << "the reference in between is no step of its own";
  EXPECT_EQ(audit_.unattended(), 0);
}

TEST_F(ASetupOfAForgetfulDrive, LosesNothingWhenItsLineDrops) {
  come_to("lower_limit");
  plant_.unplug_stage();
  answer("down 10");
  EXPECT_EQ(step(), "lower_limit");
  EXPECT_TRUE(says("cannot be asked")) << setup_.question().text;
  plant_.plug_stage();
  answer("here");
  EXPECT_EQ(step(), "reference") << "the counter may have begun anew";
  answer("home");
  EXPECT_EQ(step(), "lower_limit");
  answer("at -50");
  EXPECT_EQ(step(), "exposure");
  EXPECT_EQ(audit_.unattended(), 0);
}

TEST_F(ASetup, TeachesNoLimitByAnAxisWithoutAReference) {
  come_to("lower_limit");
  plant_.drive().power_cycle();
  answer("here");
  EXPECT_EQ(step(), "reference");
  answer("back");
  EXPECT_EQ(step(), "lower_limit");
}

/// An older file says how fast it may go, and nobody is asked about that.
class ASetupOfASlowAxis : public ASetup {
 protected:
  ASetupOfASlowAxis()
      : ASetup(test::letter_f_station({}), FVD_SOURCE_DIR "/config/drives/oriental-az.json",
               R"({"camera": {"serial": "another"}, "stage": {"speed_um_per_s": 100, "take_up_um": 7}})") {}
};

TEST_F(ASetupOfASlowAxis, IsGivenTheTimeThatItNeeds) {
  come_to("upper_limit");
  answer("up 400");
  EXPECT_EQ(step(), "upper_limit");
  EXPECT_NE(note().find("the axis stands at"), std::string::npos) << note();
  answer("here");
  EXPECT_TRUE(says("take-up of 7 um")) << setup_.question().text;
}

TEST_F(ASetup, KeepsItsQuestionAndItsAnswersWhenTheLineDrops) {
  come_to("upper_limit");
  plant_.unplug_stage();
  answer("up 50");
  EXPECT_EQ(step(), "upper_limit");
  EXPECT_FALSE(note().empty());
  EXPECT_TRUE(says("cannot be asked")) << setup_.question().text;
  answer("at 300");
  EXPECT_EQ(step(), "lower_limit") << "a position that is said needs no axis";
  EXPECT_TRUE(says("The lower limit")) << setup_.question().text;
  answer("here");
  EXPECT_EQ(step(), "lower_limit");
  plant_.plug_stage();
  answer("at -50");
  EXPECT_EQ(step(), "exposure");
  EXPECT_EQ(audit_.unattended(), 0);
}

TEST_F(ASetup, StaysWhereTheNextQuestionCannotBeMade) {
  come_to("profile");
  const auto profile = folder_ / "drive.json";
  std::filesystem::copy_file(FVD_SOURCE_DIR "/config/drives/oriental-az.json", profile);
  answer(profile.string());
  EXPECT_EQ(step(), "unit");
  answer("1");
  EXPECT_EQ(step(), "scale");
  answer("yes");
  std::filesystem::remove(profile);
  expect_refused("back", "drive.json");
  EXPECT_EQ(step(), "travel");
  EXPECT_TRUE(says("Between which positions"));
}

TEST_F(ASetup, DoesNotMoveAboveTheUpperLimitThatWasTaught) {
  come_to("upper_limit");
  answer("at 100");
  expect_refused("up 200", "above the upper limit");
}

TEST(ABench, MovesNothingThatNoAnswerPermits) {
  const test::ScratchDir folder;
  SetupBench bench(folder.path());
  test::expect_error(ErrorCode::kInternal, {"without being told to"}, [&] { (void)bench.moving_stage({}); });
}

}  // namespace
}  // namespace fvd
