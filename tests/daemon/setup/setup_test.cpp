/// The questions of the setup: what is refused, what is taken back, and that nothing moves but on an answer that says
/// so.

#include "daemon/config/config_file.hpp"
#include "tests/daemon/setup/a_setup.hpp"

namespace fvd {
namespace {

TEST_F(ASetup, BeginsWithTheCameraAndKnowsNoWayBackFromThere) {
  EXPECT_EQ(step(), "camera");
  for (const SetupChoice& choice : setup_.question().choices) EXPECT_NE(choice.word, "back");
  expect_refused("back", "first question");
}

TEST_F(ASetup, SaysWhyADeviceCannotBeHad) {
  expect_refused("127.0.0.254", "127.0.0.254");
  come_to("line");
  expect_refused("tcp host:0", "'0' is no port");
  expect_refused("carrier pigeon", "none of the answers");
  expect_refused("serial /dev/x 115200 odd-ish", "no parity");
  come_to("profile");
  expect_refused("/nonexistent.json", "there is no file");
  come_to("unit");
  expect_refused("248", "1 to 247");
}

TEST_F(ASetup, RefusesADriveThatIsNotTheProfiles) {
  come_to("profile");
  answer(FVD_SOURCE_DIR "/config/drives/leadshine-pr.json");
  expect_refused("1", "is not what the profile");
  answer("back");
  EXPECT_EQ(step(), "profile");
}

TEST_F(ASetup, MovesNothingBeforeItIsTold) {
  come_to("reference");
  expect_refused("keep", "has no reference");
  expect_refused("", "nothing was answered");
  expect_refused("yes", "none of the answers");
  expect_refused("home now", "none of the answers");
  EXPECT_EQ(audit_.unattended(), 0);
  answer("home");
  EXPECT_EQ(step(), "jog");
}

TEST_F(ASetup, RefusesMovesThatAreTooLongOrLeaveTheTravel) {
  come_to("upper_limit");
  expect_refused("up 1001", "expected a number from 0.01 to 1000");
  expect_refused("down 201", "expected a number");
  expect_refused("up -5", "expected a number");
  expect_refused("up nan", "expected a number");
  expect_refused("up 1000", "outside the stage's limits");
  expect_refused("at 1001", "position within the travel");
  expect_refused("at -1000", "leaves no travel");
}

TEST_F(ASetup, TakesAnAnswerBack) {
  come_to("towards");
  answer("yes");
  EXPECT_EQ(step(), "jog") << "turned round: it has to be seen again";
  answer("jog");
  answer("yes");
  answer("jog");
  answer("no");
  EXPECT_EQ(step(), "upper_limit");
  answer("at 100");
  EXPECT_EQ(step(), "lower_limit");
  answer("back");
  EXPECT_EQ(step(), "upper_limit");
  answer("at 400");
  EXPECT_EQ(note(), "upper limit 400 um");
  answer("back");
  answer("back");
  EXPECT_EQ(step(), "towards");
  answer("back");
  EXPECT_EQ(step(), "jog");
  EXPECT_EQ(audit_.unattended(), 0);
}

TEST_F(ASetup, ForgetsWhatWasTakenBack) {
  come_to("towards");
  answer("yes");
  answer("jog");
  answer("back");
  answer("back");
  EXPECT_EQ(step(), "reference") << "before z was turned round";
  answer("home");
  answer("jog");
  answer("no");
  answer("at 300");
  answer("at 100");
  EXPECT_EQ(step(), "exposure");
  answer("back");
  answer("back");
  answer("at 200");
  answer("at -40");
  for (const char* rest : {"picture", "ok", "picture", "ok", "picture", "upright", "unknown", "skip", "write"})
    answer(rest);
  ASSERT_TRUE(setup_.done()) << note();
  const Config written = load_config(folder_ / "fvd.json").config;
  EXPECT_FALSE(written.stage.reversed);
  EXPECT_EQ(written.stage.max, Micrometers{200.0});
  EXPECT_EQ(written.stage.min, Micrometers{-40.0});
  EXPECT_EQ(written.camera.serial, "SIM01") << "the camera that was seen, and no other";
  EXPECT_EQ(audit_.unattended(), 0);
}

TEST_F(ASetup, KeepsNothingThatNobodyLookedAt) {
  come_to("exposure");
  expect_refused("ok", "answer 'picture' first");
  answer("picture");
  answer("ok");
  expect_refused("ok", "answer 'picture' first");
  come_to("orientation");
  expect_refused("upright", "answer 'picture' first");
}

TEST_F(ASetup, LooksForTheFocusNearby) {
  come_to("focus");
  expect_refused("auto", "none of the answers");
  expect_refused("auto 301", "expected a number from 5 to 300");
  const double before_um = plant_.axis().true_position_um(HostClock::now());
  answer("auto 10");
  EXPECT_EQ(step(), "focus");
  EXPECT_GT(plant_.axis().true_position_um(HostClock::now()), before_um - 35.0) << "10 um, 20 of take-up, and no more";
}

TEST_F(ASetup, LeavesAPictureThatIsThere) {
  test::write_text(folder_ / "setup.png", "somebody's");
  come_to("exposure");
  answer("picture");
  answer("picture");
  EXPECT_EQ(setup_.question().picture, folder_ / "setup-2.png");
  EXPECT_EQ(test::read_text(folder_ / "setup.png"), "somebody's");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "setup-3.png"));
}

TEST_F(ASetup, TurnsPicturesUntilTheLetterIsUpright) {
  come_to("orientation");
  answer("mirrored");
  EXPECT_EQ(step(), "orientation");
  EXPECT_EQ(person_.answer(setup_.question()), "mirrored") << "that was wrong, and is seen";
  answer("mirrored");
  EXPECT_EQ(person_.answer(setup_.question()), "upright");
  expect_refused("sideways", "none of the answers");
}

TEST_F(ASetup, ComputesThePitchFromAScale) {
  come_to("pixel_pitch");
  expect_refused("10 10 300 10 100", "answer 'picture' first");
  answer("picture");
  expect_refused("100 50 104 53 10", "less than 10 pixels apart");
  expect_refused("100 50 400", "none of the answers");
  expect_refused("10 10 9000 10 100", "expected a number from 0 to");
  answer("50 20 290 200 150");
  EXPECT_EQ(note(), "a pixel is 0.5 um");
}

TEST_F(ASetup, RefusesATrialThatCannotBe) {
  come_to("trial");
  expect_refused("ok", "nothing was scanned yet");
  expect_refused("scan 0 120", "none of the answers");
  expect_refused("scan 0 1 5", "1 slices");
  expect_refused("scan -45 120 5", "take-up");
}

}  // namespace
}  // namespace fvd
