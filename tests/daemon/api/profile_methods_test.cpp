/// Heights along a line, as a client asks for them.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/metrology/profile/profile.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/daemon/views/made_maps.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

/// Job 1, whose map has 60 x 40 points, 2 um and 4 um apart.
class AProfile : public ADispatcher {
 protected:
  AProfile() {
    const StoredJob stored = test::stored_result(scratch_ / "J7", test::result_with(test::rough(60, 40, 0.1)));
    service_.result_dir = stored.result_dir;
    service_.result = stored.result_json;
    JobRequest request;
    request.seq = 1;
    job_id_ = service_.start(request).job.job_id;
    end_job(JobState::kCompleted);
  }
  void end_job(JobState state) {
    service_.change({1}, [state](JobStatus& job) { job.state = state; });
  }
  [[nodiscard]] json line(double from_x, double from_y, double to_x, double to_y, double width = 0.0) const {
    return {{"job_id", job_id_},
            {"from_um", {{"x", from_x}, {"y", from_y}}},
            {"to_um", {{"x", to_x}, {"y", to_y}}},
            {"width_um", width}};
  }
  int code_of(const json& params) {
    return error_of(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "result.profile"}, {"params", params}}.dump());
  }

  test::ScratchDir scratch_;
  std::string job_id_;
};

TEST_F(AProfile, HasTheHeightsOfTheMap) {
  const Surface surface = read_result_surface(scratch_ / "J7").surface;

  const json profile = result_of("result.profile", line(0.0, 30.0, 120.0, 30.0));  // the middle of row 7

  ASSERT_EQ(profile["distance_um"].size(), 60U);
  ASSERT_EQ(profile["height_um"].size(), 60U);
  ASSERT_EQ(profile["sigma_um"].size(), 60U);
  int holes = 0;
  for (int i = 0; i < 60; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto height_m = static_cast<double>(surface.height_m.at(i, 7));
    EXPECT_NEAR(profile["distance_um"][at].get<double>(), 2.0 * i + 1.0, 1e-9);
    EXPECT_EQ(profile["height_um"][at].is_null(), std::isnan(height_m)) << i;
    EXPECT_EQ(profile["sigma_um"][at].is_null(), std::isnan(height_m)) << i;
    holes += std::isnan(height_m) ? 1 : 0;
    if (std::isnan(height_m)) continue;
    EXPECT_NEAR(profile["height_um"][at].get<double>(), height_m * 1e6, 1e-9);
    EXPECT_NEAR(profile["sigma_um"][at].get<double>(), 0.2, 1e-6);
  }
  EXPECT_GT(holes, 0);
  EXPECT_LT(holes, 60);
}

TEST_F(AProfile, IsThatOfTheBand) {
  const Surface surface = read_result_surface(scratch_ / "J7").surface;
  metrology::HeightField field{Plane<double>(60, 40), {}, 2.0, 4.0, {}};
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) field.z_um.at(x, y) = static_cast<double>(surface.height_m.at(x, y)) / 1e-6;
  }
  const metrology::Profile wanted = metrology::extract_profile(
      field, {.from_x_um = 20.0, .from_y_um = 30.0, .to_x_um = 100.0, .to_y_um = 110.0, .band_width_um = 7.0});

  const json profile = result_of("result.profile", line(20.0, 30.0, 100.0, 110.0, 7.0));

  ASSERT_EQ(profile["height_um"].size(), wanted.z_um.size());
  for (std::size_t i = 0; i < wanted.z_um.size(); ++i) {
    const json& height = profile["height_um"][i];
    ASSERT_EQ(height.is_null(), std::isnan(wanted.z_um[i])) << i;
    if (!height.is_null()) EXPECT_NEAR(height.get<double>(), wanted.z_um[i], 1e-9) << i;
  }
}

TEST_F(AProfile, IsRefusedOutsideOfTheMap) {
  EXPECT_EQ(code_of(line(0.0, 30.0, 121.0, 30.0)), 1142);
  EXPECT_EQ(code_of(line(-1.0, 30.0, 100.0, 30.0)), 1142);
  EXPECT_EQ(code_of(line(0.0, 30.0, 100.0, 161.0)), 1142);
  EXPECT_EQ(code_of(line(10.0, 30.0, 100.0, 30.0, 80.0)), 1142) << "its band is";
  EXPECT_EQ(code_of(line(10.0, 30.0, 11.0, 30.0)), 1016) << "under two points";
}

TEST_F(AProfile, IsRefusedOfMoreSamplesThanOneWaitsFor) {
  // By points of 2 um: whatever the map's size, nothing is read for it.
  const auto asked = [this](double width_um) {
    return reply(json{{"jsonrpc", "2.0"},
                      {"id", 1},
                      {"method", "result.profile"},
                      {"params", line(0.0, 30.0, 4000.0, 30.0, width_um)}}
                     .dump());
  };
  EXPECT_EQ(asked(2000.0)["error"]["code"], 1142) << "2,000,000 are no reason, but they leave the map";
  const json refused = asked(2002.0)["error"];
  EXPECT_EQ(refused["code"], 1016);
  EXPECT_THAT(refused["message"].get<std::string>(),
              testing::AllOf(testing::HasSubstr("2002000 samples"), testing::HasSubstr("width_um")));
}

TEST_F(AProfile, IsRefusedWhereTheParametersAreNone) {
  const json good = line(10.0, 30.0, 100.0, 30.0);
  EXPECT_TRUE(result_of("result.profile", good).contains("height_um"));
  for (const char* key : {"job_id", "from_um", "to_um"}) {
    json params = good;
    params.erase(key);
    EXPECT_EQ(code_of(params), -32602) << key;
    for (const json& wrong :
         {json(nullptr), json(7), json("7"), json::array({1, 2}), json{{"x", 1}}, json{{"x", 1}, {"y", "2"}},
          json{{"x", 1}, {"y", nullptr}}, json{{"x", 1}, {"y", 2}, {"z", 3}}, json{{"x", 1e300}, {"y", 2}}}) {
      params = good;
      params[key] = wrong;
      if (std::string(key) == "job_id" && wrong.is_string()) continue;
      EXPECT_EQ(code_of(params), -32602) << key << " " << wrong.dump();
    }
  }
  for (const json& wrong : {json(-1), json("1"), json(nullptr), json(1e300), json::object()}) {
    json params = good;
    params["width_um"] = wrong;
    EXPECT_EQ(code_of(params), -32602) << wrong.dump();
  }
  json params = good;
  params["job_id"] = std::string(65, 'J');
  EXPECT_EQ(code_of(params), -32602);
  params = good;
  params["band"] = 1;
  EXPECT_EQ(code_of(params), -32602);
}

TEST_F(AProfile, IsRefusedWhereThereIsNoMap) {
  json params = line(10.0, 30.0, 100.0, 30.0);
  params["job_id"] = "none";
  EXPECT_EQ(code_of(params), 1007);
  params["job_id"] = job_id_;
  service_.change({1}, [](JobStatus& job) { job.removed_utc = "2026-11-30T10:00:00.000Z"; });
  EXPECT_EQ(code_of(params), 1018);
  service_.change({1}, [](JobStatus& job) { job.removed_utc.clear(); });
  std::filesystem::resize_file(scratch_ / "J7" / "height.tiff", 100);
  EXPECT_EQ(code_of(params), 1144);
  std::filesystem::remove(scratch_ / "J7" / "height.tiff");
  EXPECT_EQ(code_of(params), 1144);
  end_job(JobState::kFailed);
  EXPECT_EQ(code_of(params), 1016);
}

}  // namespace
}  // namespace fvd
