#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/export/result_writer.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/report/sample_report.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::run_command;
using test::ScratchDir;
using testing::HasSubstr;

/// A result with an evaluation, written as a job writes it.
void write_job(const std::filesystem::path& folder, std::optional<double> pitch_um) {
  ResultData data = test::sample_result();
  data.evaluation = test::sample_evaluation();
  data.pixel_pitch_x_um = data.pixel_pitch_y_um = pitch_um;
  data.exports = {{"height.tiff", "sigma.tiff", "mask.png", "report.pdf", "sigma.png", "holes.png", "view3d.png"}};
  write_result(folder, data);
}

TEST(FvdctlReport, GivesTheBytesOfTheJobsOwnReport) {
  const ScratchDir scratch;
  write_job(scratch / "job", 2.0);
  const std::string out = (scratch / "again.pdf").string();

  const auto outcome = run_command({"report", (scratch / "job").string(), "--out", out});

  EXPECT_EQ(outcome.code, ctl::kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("verdict   pass"), HasSubstr(out)));
  const std::string pdf = test::read_text(out);
  EXPECT_TRUE(pdf.starts_with("%PDF-"));
  EXPECT_TRUE(pdf == test::read_text(scratch / "job/report.pdf"));
  for (const char* picture : {"sigma.png", "holes.png", "view3d.png"}) {
    EXPECT_TRUE(test::read_text(scratch / "job" / picture).starts_with("\x89PNG")) << picture;
  }
}

TEST(FvdctlReport, AsksForThePitchThatAResultDoesNotTell) {
  const ScratchDir scratch;
  write_job(scratch / "job", std::nullopt);
  const std::string out = (scratch / "again.pdf").string();

  const auto without = run_command({"report", (scratch / "job").string(), "--out", out});
  const auto with = run_command({"report", (scratch / "job").string(), "--out", out, "--pitch-um", "2"});

  EXPECT_EQ(without.code, ctl::kExitBadData);
  EXPECT_THAT(without.err, HasSubstr("distance of its points"));
  EXPECT_EQ(with.code, ctl::kExitOk) << with.err;
}

TEST(FvdctlReport, RefusesWhatIsNoResultAndAFileThatIsThere) {
  const ScratchDir scratch;
  write_job(scratch / "job", 2.0);
  const std::string out = (scratch / "again.pdf").string();

  EXPECT_EQ(run_command({"report", (scratch / "none").string(), "--out", out}).code, ctl::kExitBadData);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(run_command({"report", (scratch / "job").string(), "--out", out}).code, ctl::kExitOk);
  EXPECT_EQ(run_command({"report", (scratch / "job").string(), "--out", out}).code, ctl::kExitIo);
}

}  // namespace
}  // namespace fvd
