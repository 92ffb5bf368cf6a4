#include "drivers/modbus/drive_profile.hpp"

#include <filesystem>
#include <string>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

const std::string kShipped = FVD_SOURCE_DIR "/config/drives/oriental-az.json";

/// The shipped profile with one place changed by a JSON patch; the problems it then has.
std::string problems_of(const char* operation, const std::string& path, const nlohmann::json& value) {
  Problems none;
  auto document = parse_strict_json(read_text_file(kShipped), none).value();
  document = document.patch({{{"op", operation}, {"path", path}, {"value", value}}});
  try {
    (void)parse_drive_profile(document.dump(), "profile");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadConfig);
    return error.what();
  }
  return "";
}

TEST(DriveProfile, ReadsTheShippedOne) {
  const DriveProfile profile = load_drive_profile(kShipped);
  EXPECT_EQ(profile.name, "Oriental Motor AZ");
  EXPECT_EQ(profile.position.address, 0x00CC);
  EXPECT_EQ(profile.feedback, FeedbackSource::kMotorEncoder);
  ASSERT_EQ(profile.move_absolute.size(), 1U) << "the move is one frame";
  EXPECT_EQ(std::get<WriteStep>(profile.move_absolute[0]).writes.front().reg.address, 0x0058);
  EXPECT_EQ(alarm_text(profile, 0x67), "alarm 0x67: software overtravel");
}

TEST(DriveProfile, ReadsEveryShippedOne) {
  int profiles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FVD_SOURCE_DIR "/config/drives")) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().string());
    DriveProfile profile;
    EXPECT_NO_THROW(profile = load_drive_profile(entry.path()));
    EXPECT_FALSE(profile.move_absolute.empty());
    ++profiles;
  }
  EXPECT_GE(profiles, 6);
}

TEST(DriveProfile, EncodesAndDecodesBaseThousand) {
  const DriveRegister reg{.type = RegisterType::kI32, .codec = RegisterCodec::kBase1000};
  for (const std::int64_t value : {0LL, 7LL, -7LL, 12345LL, -98765LL, 32767999LL}) {
    EXPECT_EQ(decode(reg, encode(reg, value).data()), value);
  }
  EXPECT_EQ(encode(reg, 12345), (std::vector<std::uint16_t>{12, 345}));
}

TEST(DriveProfile, ClampsAndInvertsUnits) {
  const DriveUnit time{.factor = 16666667.0, .inverse = true, .min = 1, .max = 32767};
  EXPECT_EQ(time.value(20000.0), 833);
  EXPECT_EQ(time.value(1.0), 32767);
  EXPECT_EQ(time.value(1e12), 1);
  EXPECT_EQ((DriveUnit{.factor = 0.06, .max = 5000}.value(1e9)), 5000);
}

TEST(DriveProfile, EncodesAndDecodesBothWordOrders) {
  for (const WordOrder order : {WordOrder::kHighFirst, WordOrder::kLowFirst}) {
    const DriveRegister reg{.address = 10, .type = RegisterType::kI32, .order = order};
    for (const std::int64_t value : {0LL, 1LL, -1LL, -500000LL, 2147483647LL, -2147483648LL}) {
      EXPECT_EQ(decode(reg, encode(reg, value).data()), value);
    }
  }
  EXPECT_EQ(encode({.type = RegisterType::kI32}, -2), (std::vector<std::uint16_t>{0xFFFF, 0xFFFE}));
  EXPECT_EQ(encode({.type = RegisterType::kU32, .order = WordOrder::kLowFirst}, 0x10002),
            (std::vector<std::uint16_t>{2, 1}));
}

TEST(DriveProfile, RefusesEachKindOfMistakeWithItsPlace) {
  const auto names = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_PRED2(names, problems_of("add", "/sped", 1), "/sped: unknown key");
  EXPECT_PRED2(names, problems_of("replace", "/scale/steps_per_um", 0), "/scale/steps_per_um: 0 is not accepted");
  EXPECT_PRED2(names, problems_of("replace", "/scale/direction", "up"), "/scale/direction");
  EXPECT_PRED2(names, problems_of("replace", "/registers/speed/address", "0x1FFFF"), "/registers/speed/address");
  EXPECT_PRED2(names, problems_of("replace", "/registers/speed/address", "0xZZ"), "/registers/speed/address");
  EXPECT_PRED2(names, problems_of("replace", "/registers/speed/type", "f16"), "/registers/speed/type");
  EXPECT_PRED2(names, problems_of("replace", "/status/moving/register", "outputs"), "'outputs' is not one of");
  EXPECT_PRED2(names, problems_of("replace", "/status/moving/mask", 0), "/status/moving/mask");
  EXPECT_PRED2(names, problems_of("replace", "/sequences/stop/0/write/0/1", "$targets"), "/sequences/stop/0/write/0/1");
  EXPECT_PRED2(names, problems_of("replace", "/sequences/stop", nlohmann::json::array()), "needs at least one step");
  EXPECT_PRED2(names, problems_of("add", "/sequences/stop/0/write/-", nlohmann::json{"trigger", 1}),
               "must follow each other");
  EXPECT_PRED2(names, problems_of("replace", "/poll/1/count", 1), "is in none of the blocks");
  EXPECT_PRED2(names, problems_of("replace", "/registers", 5), "/registers");
}

TEST(DriveProfile, ReportsAllMistakesAtOnce) {
  const std::string text = problems_of("replace", "/scale", {{"steps_per_um", -1}, {"speed_units_per_um_s", "fast"}});
  EXPECT_NE(text.find("/scale/steps_per_um"), std::string::npos);
  EXPECT_NE(text.find("/scale/speed_units_per_um_s"), std::string::npos);
  EXPECT_NE(text.find("/scale/acceleration_units_per_um_s2: is missing"), std::string::npos);
}

TEST(DriveProfile, RefusesTextThatIsNoProfile) {
  EXPECT_THROW((void)parse_drive_profile("[]", "x"), Error);
  EXPECT_THROW((void)parse_drive_profile("{\"name\": }", "x"), Error);
  EXPECT_THROW((void)load_drive_profile("/nonexistent.json"), Error);
}

}  // namespace
}  // namespace fvd
