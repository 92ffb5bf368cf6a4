/// The simulated controller against what the manuals say of GCS 2.0.

#include "sim/gcs/gcs_controller.hpp"

#include "gtest/gtest.h"

namespace fvd::sim {
namespace {

class AGcsController : public testing::Test {
 protected:
  std::string say(const std::string& text) { return controller_.take(text); }
  void home() {
    (void)say("SVO 1 1\nFRF 1\n");
    while (say("FRF? 1\n") != "1=1\n") {
    }
  }

  AxisModel axis_{AxisParameters{}};
  GcsController controller_{axis_};
};

TEST_F(AGcsController, AnswersQuestionsByAxisAndValue) {
  EXPECT_EQ(say("SVO? 1\n"), "1=0\n");
  EXPECT_EQ(say("TMN? 1\nTMX? 1\n"), "1=-2.000000\n1=2.000000\n");
  EXPECT_EQ(say("SAI?\n"), "1\n");
  EXPECT_EQ(say("\x05"), "0\n") << "without a line feed";
}

TEST_F(AGcsController, TakesCommandsThatComeInParts) {
  EXPECT_EQ(say("SV"), "");
  EXPECT_EQ(say("O 1 1\nSVO? "), "");
  EXPECT_EQ(say("1\n"), "1=1\n");
}

TEST_F(AGcsController, TellsAnErrorOnce) {
  (void)say("NONSENSE 1\n");
  EXPECT_EQ(say("ERR?\n"), "2\n");
  EXPECT_EQ(say("ERR?\n"), "0\n");
  (void)say("POS? 7\n");
  EXPECT_EQ(say("ERR?\n"), "15\n");
}

TEST_F(AGcsController, MovesOnlyWithServoAndReferenceAndWithinItsTravel) {
  (void)say("MOV 1 0.1\n");
  EXPECT_EQ(say("ERR?\n"), "5\n");
  home();
  (void)say("MOV 1 2.5\n");
  EXPECT_EQ(say("ERR?\n"), "7\n");
  EXPECT_EQ(controller_.moves(), 0);
  (void)say("MOV 1 0.1\n");
  EXPECT_EQ(say("ERR?\n"), "0\n");
  EXPECT_EQ(controller_.moves(), 1);
}

TEST_F(AGcsController, StopsAndSaysSoByErrorTen) {
  home();
  (void)say("MOV 1 1.9\n");
  while (say("\x05") != "1\n") {
  }
  EXPECT_EQ(say("HLT 1\nERR?\n"), "10\n");
  while (say("\x05") != "0\n") {
  }
  EXPECT_NE(say("POS? 1\n").substr(0, 5), "1=1.9");
}

TEST_F(AGcsController, LosesItsServoInAnAlarm) {
  home();
  controller_.raise_alarm(-1024);
  EXPECT_EQ(say("SVO? 1\nERR?\n"), "1=0\n-1024\n");
}

}  // namespace
}  // namespace fvd::sim
