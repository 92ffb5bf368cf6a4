#include "daemon/events/topic.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

using std::chrono::milliseconds;

class ATopic : public ::testing::Test {
 protected:
  /// Whether a document with these figures is told now.
  bool told(const std::string& state, int progress, int clock) {
    const std::string compared = state + std::to_string(progress);
    return topic_.take({compared + "@" + std::to_string(clock), compared, state}, now_);
  }
  HostTime now_{std::chrono::hours(1)};
  Topic topic_{milliseconds(100)};
};

TEST_F(ATopic, IsNothingBeforeItsFirstDocument) { EXPECT_EQ(topic_.text(), "null"); }

TEST_F(ATopic, TellsWhatChanged) {
  EXPECT_FALSE(told("ready", 0, 0)) << "readers begin with it";
  EXPECT_EQ(topic_.text(), "ready0@0");
  EXPECT_FALSE(told("ready", 0, 0));
  EXPECT_TRUE(told("executing", 0, 0));
  EXPECT_TRUE(told("ready", 0, 0)) << "at once";
}

TEST_F(ATopic, TellsNothingOfClocksButHasThemRight) {
  (void)told("ready", 0, 0);
  EXPECT_FALSE(told("ready", 0, 5));
  EXPECT_EQ(topic_.text(), "ready0@5");
}

TEST_F(ATopic, TellsFiguresAfterAWhile) {
  (void)told("executing", 0, 0);
  now_ += milliseconds(50);
  EXPECT_FALSE(told("executing", 1, 0));
  EXPECT_EQ(topic_.text(), "executing1@0") << "whoever begins to read has it";
  now_ += milliseconds(50);
  EXPECT_TRUE(told("executing", 1, 0)) << "none is forgotten";
  EXPECT_FALSE(told("executing", 2, 0));
  EXPECT_TRUE(told("ready", 2, 0)) << "with what waits no longer";
  now_ += milliseconds(200);
  EXPECT_FALSE(told("ready", 2, 0));
}

TEST_F(ATopic, CorrectsWhatItHasShown) {
  (void)told("executing", 0, 0);
  EXPECT_FALSE(told("executing", 1, 0));
  EXPECT_TRUE(topic_.owes());
  EXPECT_EQ(topic_.show(), "executing1@0");
  EXPECT_FALSE(told("executing", 0, 0)) << "it waits all the same";
  EXPECT_TRUE(topic_.owes());
  now_ += milliseconds(100);
  EXPECT_TRUE(told("executing", 0, 0)) << "whoever was shown the other one would have it for good";
  EXPECT_FALSE(topic_.owes());
  now_ += milliseconds(100);
  EXPECT_FALSE(told("executing", 0, 0)) << "once";
}

TEST_F(ATopic, TellsNothingOfWhatNobodySaw) {
  (void)told("executing", 0, 0);
  EXPECT_EQ(topic_.show(), "executing0@0");
  EXPECT_FALSE(told("executing", 1, 0));
  EXPECT_FALSE(told("executing", 0, 0));
  EXPECT_FALSE(topic_.owes());
  now_ += milliseconds(200);
  EXPECT_FALSE(told("executing", 0, 0));
}

}  // namespace
}  // namespace fvd
