/// Studies of results in folders, where there is no daemon.

#include <gmock/gmock.h>

#include "daemon/study/study_input.hpp"
#include "tests/daemon/study/study_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

class AFolderStudy : public test::AStudyDesk {
 protected:
  std::string folder_of(const std::string& id, double lift_um = 0.0) {
    keep(surface_data(id, [lift_um](int x, int y) { return lift_um + 0.2 * ((x * 7 + y * 3) % 5); }));
    return (scratch_ / id).string();
  }
  static std::string jobs_json(const std::vector<std::string>& folders) {
    std::string list;
    for (const std::string& folder : folders) list += (list.empty() ? "\"" : ",\"") + folder + "\"";
    return R"({"jobs": [)" + list + "]}";
  }
};

TEST_F(AFolderStudy, HasTheFiguresOfTheDaemonsStudy) {
  const std::vector<std::string> folders{folder_of("a"), folder_of("b", 0.1)};

  const Study study = study_of_folders(read_study_request("verify.noise", jobs_json(folders)), {});

  EXPECT_EQ(study.figures, make("verify.noise", NoiseRequest{{"a", "b"}, {}}).figures);
  EXPECT_EQ(study.jobs, folders);
  EXPECT_EQ(study.kind, "verify.noise");
  EXPECT_EQ(study.id, "");
  EXPECT_TRUE(study.files.empty());
}

TEST_F(AFolderStudy, IsRefusedWhereAFolderIsNoResult) {
  const std::string good = folder_of("a");
  std::filesystem::create_directories(scratch_ / "empty");
  const auto study = [&](const std::string& other) {
    return study_of_folders(read_study_request("verify.noise", jobs_json({good, other})), {});
  };

  FVD_EXPECT_ERROR_SAYING(kUnknownJob, study((scratch_ / "empty").string()), HasSubstr("empty' is no folder"));
  FVD_EXPECT_ERROR_SAYING(kUnknownJob, study((scratch_ / "none").string()), HasSubstr("none"));
  test::write_text(scratch_ / "empty" / "result.json", "{\"format\":");
  FVD_EXPECT_ERROR(kBadInput, study((scratch_ / "empty").string()));
}

TEST(AStudysParameters, AreReadAsTheMethodsTakeThem) {
  const StudyRequest lateral = read_study_request(
      "calibrate.lateral",
      R"({"job": "/r/1", "second_job": "/r/2", "grid_pitch_um": 40, "u_grid_relative": 1e-4, "person": "anna",
          "region": {"circle_um": {"x": 5, "y": 6, "radius": 4}}})");
  const StudyRequest star =
      read_study_request("verify.resolution", R"({"job": "a", "artefact": "star", "pairs": 36, "height_um": 0.5})");

  const auto& grid = std::get<LateralRequest>(lateral.input);
  EXPECT_EQ(lateral.person, "anna");
  EXPECT_EQ(grid.second_job, "/r/2");
  EXPECT_EQ(grid.grid_pitch_um, 40.0);
  EXPECT_EQ(grid.u_grid_relative, 1e-4);
  ASSERT_TRUE(grid.region.circle);
  EXPECT_EQ(grid.region.circle->radius_um, 4.0);
  EXPECT_EQ(std::get<ResolutionRequest>(star.input).pairs, 36);
  EXPECT_EQ(std::get<ResolutionRequest>(star.input).height_um, 0.5);
}

TEST(AStudysParameters, AreRefusedWithWhatIsWrongOfThem) {
  const auto read = [](const std::string& kind, const std::string& json) { (void)read_study_request(kind, json); };

  FVD_EXPECT_ERROR_SAYING(kBadInput, read("calibrate.lateral", R"({"job": "a"})"), HasSubstr("grid_pitch_um"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, read("calibrate.lateral", R"({"job": "a", "grid_pitch_um": -4})"),
                          HasSubstr("grid_pitch_um"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, read("verify.resolution", R"({"job": "a", "artefact": "stair"})"),
                          HasSubstr("artefact"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, read("verify.resolution", R"({"job": "a", "artefact": "star", "pairs": 2})"),
                          HasSubstr("pairs"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, read("verify.sphere", R"({"job": "a", "radius_um": 0})"), HasSubstr("radius_um"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, read("verify.sphere", R"({"job": "a", "radius_um": 5, "radius": 4})"),
                          HasSubstr("radius"));
  FVD_EXPECT_ERROR_SAYING(
      kBadInput, read("verify.hysteresis", R"({"up": "a", "down": "b", "region": {"circle_um": {"x": 1, "y": 1}}})"),
      HasSubstr("/region/circle_um"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, read("verify.texture", R"({"jobs": ["a", "b"]})"), HasSubstr("measurement"));
  FVD_EXPECT_ERROR(kBadInput, read("gauge.capability", R"({"type1": "study-0001", "rr": "study-0002"})"));
  FVD_EXPECT_ERROR(kBadInput, read("verify.everything", "{}"));
}

}  // namespace
}  // namespace fvd
