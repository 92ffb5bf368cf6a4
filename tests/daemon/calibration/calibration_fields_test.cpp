#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "tests/daemon/calibration/some_calibration.hpp"

namespace fvd {
namespace {

using test::whole_calibration;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string written(Calibration calibration) {
  return fields_to_json([&](Fields& fields) { describe(calibration, fields); }).dump();
}

Calibration read_back(const std::string& text, Problems& problems) {
  Calibration calibration;
  read_document(
      text, [&](Fields& fields) { describe(calibration, fields); }, problems);
  return calibration;
}

TEST(CalibrationFields, ReadBackAsTheyWereWritten) {
  Problems problems;

  const Calibration back = read_back(written(whole_calibration()), problems);

  EXPECT_THAT(problems, IsEmpty());
  EXPECT_EQ(back, whole_calibration());
}

TEST(CalibrationFields, LeaveOutWhatIsNotKnown) {
  Calibration calibration;
  calibration.id = "cal-0001";
  calibration.z = ZConstants{};
  Problems problems;

  const std::string text = written(calibration);

  EXPECT_EQ(read_back(text, problems), calibration);
  EXPECT_THAT(problems, IsEmpty());
  EXPECT_FALSE(nlohmann::json::parse(text).contains("lateral"));
}

TEST(CalibrationFields, RefuseConstantsThatLackTheirValue) {
  for (const auto& [part, key] : {std::pair("z", "alpha_z"), {"flatness", "flatness_um"}, {"lateral", "pitch_y_um"}}) {
    nlohmann::json json = nlohmann::json::parse(written(whole_calibration()));
    json[part].erase(key);
    Problems problems;

    (void)read_back(json.dump(), problems);

    ASSERT_THAT(problems, SizeIs(1));
    EXPECT_EQ(problems.front().pointer, std::string("/") + part + "/" + key);
  }
}

TEST(CalibrationFields, RefuseAnAmplificationThatNoInstrumentHas) {
  Calibration calibration = whole_calibration();
  calibration.z->alpha_z = 0.0;
  Problems problems;

  (void)read_back(written(calibration), problems);

  ASSERT_THAT(problems, SizeIs(1));
  EXPECT_EQ(problems.front().pointer, "/z/alpha_z");
}

TEST(LapsedConstants, AreThoseWhoseLastDayIsBeforeToday) {
  Calibration calibration = whole_calibration();
  calibration.z->origin.renew_by = "2026-11-28";
  calibration.flatness->origin.renew_by = "2026-11-29";
  calibration.noise->origin.renew_by = "";
  calibration.texture.reset();

  EXPECT_THAT(lapsed(calibration, "2026-11-29"), ElementsAre("z"));
  EXPECT_THAT(lapsed(calibration, "2027-11-30"), ElementsAre("z", "flatness", "lateral"));
}

}  // namespace
}  // namespace fvd
