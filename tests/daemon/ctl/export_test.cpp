#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/surface_files/surface_files.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::run_command;
using test::ScratchDir;
using testing::HasSubstr;

TEST(FvdctlExport, GivesOfAResultTheBytesThatTheJobWouldHave) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  std::vector<std::string> names{"height.tiff", "sigma.tiff", "texture.png"};
  for (const SurfaceWriter& writer : surface_writers()) names.emplace_back(writer.file);
  data.exports = names;
  write_result(scratch / "job", data);
  for (const SurfaceWriter& writer : surface_writers()) {
    const std::string file(writer.file);

    const auto outcome = run_command({"export", (scratch / "job").string(), "--format", std::string(writer.format),
                                      "--out", (scratch / file).string()});

    EXPECT_EQ(outcome.code, ctl::kExitOk) << outcome.err;
    EXPECT_TRUE(test::read_text(scratch / file) == test::read_text(scratch / "job" / file)) << file;
    EXPECT_THAT(outcome.out, HasSubstr("6 x 3, 2 holes"));
  }
}

TEST(FvdctlExport, TurnsOneFormatIntoAnother) {
  const ScratchDir scratch;
  test::write_text(scratch / "a.csv", "# unit = um\n1,2,nan\n4,5,6\n");

  const auto outcome = run_command({"export", (scratch / "a.csv").string(), "--format", "x3p", "--out",
                                    (scratch / "a.x3p").string(), "--pitch-um", "0.5,0.25"});

  EXPECT_EQ(outcome.code, ctl::kExitOk) << outcome.err;
  const Surface surface = read_surface(scratch / "a.x3p");
  EXPECT_EQ(surface.pitch_x_um, 0.5);
  EXPECT_EQ(surface.pitch_y_um, 0.25);
  EXPECT_EQ(surface.height_m.at(2, 1), 6e-6F);
  EXPECT_TRUE(std::isnan(surface.height_m.at(2, 0)));
}

TEST(FvdctlExport, SaysWhatIsWrong) {
  const ScratchDir scratch;
  test::write_text(scratch / "a.csv", "# unit = um\n1,2\n3\n");
  const std::string out = (scratch / "a.gsf").string();

  const auto bad = run_command({"export", (scratch / "a.csv").string(), "--format", "gsf", "--out", out});
  EXPECT_EQ(bad.code, ctl::kExitBadData);
  EXPECT_THAT(bad.err, testing::AllOf(HasSubstr("a.csv: line 3"), HasSubstr("the first row has 2")));
  EXPECT_FALSE(std::filesystem::exists(out));

  test::write_text(scratch / "a.csv", "# unit = um\n1,2\n3,4\n");
  const std::vector<std::string> good{
      "export", (scratch / "a.csv").string(), "--format", "gsf", "--out", out, "--pitch-um", "1"};
  EXPECT_EQ(run_command(good).code, ctl::kExitOk);
  EXPECT_EQ(run_command(good).code, ctl::kExitIo) << "the file is there already";
  EXPECT_EQ(run_command({"export", "x", "--format", "obj", "--out", out}).code, ctl::kExitUsage);
  EXPECT_EQ(run_command({"export", "x", "--format", "gsf", "--out", out, "--pitch-um", "1,2,3"}).code, ctl::kExitUsage);
  EXPECT_EQ(run_command({"export", (scratch / "none").string(), "--format", "gsf", "--out", out}).code,
            ctl::kExitBadData);
}

}  // namespace
}  // namespace fvd
