#include "daemon/jobs/part_temperature.hpp"

#include <chrono>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

class ATemperatureFile : public ::testing::Test {
 protected:
  ATemperatureFile() { source_.file = folder_.path() / "temp1_input"; }

  [[nodiscard]] TemperatureReading read(const std::string& text, seconds age = seconds(0)) {
    test::write_text(source_.file, text);
    return read_temperature(source_, now() + age);
  }
  /// The time at which the file was written.
  [[nodiscard]] std::chrono::system_clock::time_point now() const {
    struct stat status {};
    ::stat(source_.file.c_str(), &status);
    return std::chrono::system_clock::time_point(seconds(status.st_mtim.tv_sec) +
                                                 std::chrono::nanoseconds(status.st_mtim.tv_nsec));
  }

  test::ScratchDir folder_;
  TemperatureConfig source_;
};

TEST_F(ATemperatureFile, TellsDegreesByScaleAndOffset) {
  source_.scale = 0.001;
  source_.offset_c = -0.5;

  const TemperatureReading reading = read("21375\n", seconds(30));

  ASSERT_TRUE(reading.temperature.has_value()) << reading.problem;
  EXPECT_NEAR(reading.temperature->celsius, 20.875, 1e-12);
  EXPECT_EQ(reading.temperature->source, source_.file.string());
  EXPECT_NEAR(reading.temperature->age_s, 30.0, 1e-3);
}

TEST_F(ATemperatureFile, MayHaveSpaceAndASignAroundItsNumber) {
  for (const char* text : {"20.5", " +20.5\r\n", "\t20.5  ", "2.05e1"}) {
    const TemperatureReading reading = read(text);
    ASSERT_TRUE(reading.temperature.has_value()) << text << reading.problem;
    EXPECT_EQ(reading.temperature->celsius, 20.5) << text;
  }
  EXPECT_EQ(read("-3.5").temperature.value().celsius, -3.5);
}

TEST_F(ATemperatureFile, TellsNothingWhereItHoldsAnythingElse) {
  for (const std::string& text : {std::string(), std::string("\n"), std::string("warm"), std::string("20.5 C"),
                                  std::string("20,5"), std::string("20 21"), std::string("nan"), std::string("inf"),
                                  std::string("0x14"), std::string("++20"), std::string("+-20"), std::string("1e999"),
                                  std::string("20\0", 3), std::string(65, '0'), std::string(1U << 20U, ' ') + "20"}) {
    const TemperatureReading reading = read(text);
    EXPECT_FALSE(reading.temperature.has_value()) << text.substr(0, 70);
    EXPECT_THAT(reading.problem, HasSubstr("one number")) << text.substr(0, 70);
  }
}

TEST_F(ATemperatureFile, TellsNothingThatNoRoomHas) {
  EXPECT_THAT(read("21375").problem, HasSubstr("temperature.scale")) << "millidegrees without their scale";
  EXPECT_THAT(read("100.01").problem, HasSubstr("outside"));
  EXPECT_THAT(read("-50.01").problem, HasSubstr("outside"));
  EXPECT_TRUE(read("100").temperature.has_value());
  EXPECT_TRUE(read("-50").temperature.has_value());
}

TEST_F(ATemperatureFile, TellsNothingOfNowOnceItIsTooOld) {
  source_.max_age_s = 60;

  EXPECT_TRUE(read("20", seconds(60)).temperature.has_value());
  const TemperatureReading old = read("20", seconds(61));

  EXPECT_FALSE(old.temperature.has_value());
  EXPECT_THAT(old.problem, HasSubstr("61 s ago"));
}

TEST_F(ATemperatureFile, MayBeALittleNewerThanNowButNotMuch) {
  const TemperatureReading reading = read("20", seconds(-4));
  ASSERT_TRUE(reading.temperature.has_value());
  EXPECT_EQ(reading.temperature->age_s, 0.0);
  EXPECT_THAT(read("20", seconds(-6)).problem, HasSubstr("set the clocks"));
}

TEST_F(ATemperatureFile, IsReadWithoutWaitingWhateverItIs) {
  EXPECT_THAT(read_temperature(source_, {}).problem, HasSubstr("cannot be opened"));
  ASSERT_EQ(::mkfifo(source_.file.c_str(), 0600), 0);
  EXPECT_THAT(read_temperature(source_, {}).problem, HasSubstr("no regular file")) << "a pipe would wait for a writer";
  source_.file = folder_.path();
  EXPECT_THAT(read_temperature(source_, {}).problem, HasSubstr("no regular file"));
  source_.file = "/dev/zero";
  EXPECT_THAT(read_temperature(source_, {}).problem, HasSubstr("no regular file"));
}

TEST_F(ATemperatureFile, OfSysfsIsNeverOld) {
  source_.file = "/sys/class/net/lo/mtu";
  source_.scale = 0.0003;  // 65536 bytes
  source_.max_age_s = 1;
  if (!std::ifstream(source_.file).good()) GTEST_SKIP() << "no such file in this kernel";

  const TemperatureReading reading =
      read_temperature(source_, std::chrono::system_clock::now() + std::chrono::hours(1000));

  ASSERT_TRUE(reading.temperature.has_value()) << reading.problem;
  EXPECT_EQ(reading.temperature->age_s, 0.0);
}

TEST_F(ATemperatureFile, GivesWayToTheJobsOwnValue) {
  test::write_text(source_.file, "20");
  ResultData result;
  JobRequest request;
  request.temperature_c = 21.5;

  note_temperature(request, source_, result);

  EXPECT_EQ(result.temperature, (Temperature{21.5, "job", 0.0}));
  EXPECT_TRUE(result.warnings.empty());
}

TEST_F(ATemperatureFile, IsAWarningWhereItTellsNothing) {
  ResultData result;

  note_temperature({}, source_, result);

  EXPECT_FALSE(result.temperature.has_value());
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0].code, "temperature_unknown");
  EXPECT_THAT(result.warnings[0].text, HasSubstr(source_.file.string()));
}

TEST(APartsTemperature, IsAbsentWithoutAWordWhereNobodyIsToTellIt) {
  ResultData result;

  note_temperature({}, {}, result);

  EXPECT_FALSE(result.temperature.has_value());
  EXPECT_TRUE(result.warnings.empty());
}

}  // namespace
}  // namespace fvd
