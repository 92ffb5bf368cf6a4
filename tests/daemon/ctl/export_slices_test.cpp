#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "daemon/export/result_writer.hpp"
#include "drivers/replay/recorded_stack.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::run_command;
using test::ScratchDir;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kWidth = 5;
constexpr int kHeight = 3;

/// Levels that are multiples of 16, as a camera of 8 bits in a file of 16 has them.
std::uint16_t level(int slice, int x, int y, PixelFormat format) {
  const int value = 16 * (slice * 31 + y * 7 + x);
  return static_cast<std::uint16_t>(format == PixelFormat::kMono8 ? value % 256 : value % max_grey_level(format));
}

std::string pgm(int slice, PixelFormat format) {
  Plane<std::uint8_t> narrow(kWidth, kHeight);
  Plane<std::uint16_t> wide(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      wide.at(x, y) = level(slice, x, y, format);
      narrow.at(x, y) = static_cast<std::uint8_t>(wide.at(x, y));
    }
  }
  return encode_pgm(format == PixelFormat::kMono8 ? image_view(narrow.view(), format)
                                                  : image_view(wide.view(), format));
}

/// A job of three slices at 10.0625, 20.125 and 29.9 um, that were to be 10 um apart.
struct KeptJob {
  explicit KeptJob(PixelFormat format = PixelFormat::kMono12, ResultData data = test::sample_result()) {
    data.exposure_us = 750.0;
    data.exports = {{"height.tiff"}};
    write_result(scratch / "job", data);
    fs::create_directory(scratch / "job" / "slices");
    for (int i = 0; i < 3; ++i) test::write_text(slice(i), pgm(i, format));
    test::write_text(scratch / "job/slices/z.txt", "# job J7, simulated\n# measured z in um\n10.0625\n20.125\n29.9\n");
  }

  [[nodiscard]] fs::path slice(int index) const { return scratch / "job" / "slices" / recorded_slice_name(index); }
  [[nodiscard]] fs::path file() const { return scratch / "stack.ome.tif"; }
  [[nodiscard]] test::Outcome exported(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"export",       (scratch / "job").string(), "--format", "ome-tiff", "--out",
                                       file().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_command(arguments);
  }

  ScratchDir scratch;
};

TEST(FvdctlExportSlices, MakesAStackThatReadsBackAsItWasRecorded) {
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kMono10, PixelFormat::kMono12, PixelFormat::kMono16}) {
    SCOPED_TRACE(significant_bits(format));
    const KeptJob job(format);

    const auto outcome = job.exported();

    ASSERT_EQ(outcome.code, ctl::kExitOk) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("3 of 5 x 3 pixels"), HasSubstr("10.0625 to 29.9 um")));
    const SliceList list = find_slices(job.file());
    EXPECT_THAT(list.z_um, testing::ElementsAre(10.0625, 20.125, 29.9));
    EXPECT_EQ(list.pixel_pitch_x_um, 2.0);
    EXPECT_EQ(list.pixel_pitch_y_um, 4.0);
    EXPECT_TRUE(list.doubt.empty()) << list.doubt;
    ImageFile page;
    for (int i = 0; i < 3; ++i) {
      decode_slice(list.slices[static_cast<std::size_t>(i)], page);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const std::byte* const sample = page.row(y) + x * page.bytes_per_sample;
          const int found =
              page.bytes_per_sample == 1 ? static_cast<int>(*sample) : *reinterpret_cast<const std::uint16_t*>(sample);
          EXPECT_EQ(found, level(i, x, y, format)) << i << " " << x << " " << y;
        }
      }
    }
  }
}

/// What tifffile reads of the file; nothing where it is not installed.
json tifffile_reads(const fs::path& file) {
  const std::string command =
      "/usr/bin/python3 " FVD_SOURCE_DIR "/tests/daemon/ctl/read_ome_tiff.py '" + file.string() + "' 2>&1";
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    text.append(buffer.data(), count);
  }
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127)) return nullptr;
  if (status != 0) throw std::runtime_error(text);
  return json::parse(text);
}

TEST(FvdctlExportSlices, IsReadByTifffileWithItsShapeScaleAndPixels) {
  const KeptJob job;
  ASSERT_EQ(job.exported().code, ctl::kExitOk);

  const json read = tifffile_reads(job.file());

  if (read.is_null()) GTEST_SKIP() << "tifffile (python3-tifffile) is not installed";
  EXPECT_EQ(read["is_ome"], true);
  EXPECT_EQ(read["is_bigtiff"], false);
  EXPECT_EQ(read["axes"], "ZYX");
  EXPECT_EQ(read["shape"], json({3, kHeight, kWidth}));
  EXPECT_EQ(read["dtype"], "uint16");
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) EXPECT_EQ(read["pixels"][at++], level(i, x, y, PixelFormat::kMono12));
    }
  }
  EXPECT_EQ(read["image"]["Name"], "part-42");
  EXPECT_THAT(read["image"]["AcquisitionDate"], "2023-11-14T22:13:20Z");
  EXPECT_THAT(read["image"]["Description"].get<std::string>(), AllOf(HasSubstr("job J7"), HasSubstr("SIMULATED")));
  const json pixels = read["image"]["Pixels"];
  EXPECT_EQ(pixels["DimensionOrder"], "XYZCT");
  EXPECT_EQ(pixels["SizeX"], kWidth);
  EXPECT_EQ(pixels["SizeY"], kHeight);
  EXPECT_EQ(pixels["SizeZ"], 3);
  EXPECT_EQ(pixels["Type"], "uint16");
  EXPECT_EQ(pixels["SignificantBits"], 12);
  EXPECT_EQ(pixels["PhysicalSizeX"], 2);
  EXPECT_EQ(pixels["PhysicalSizeY"], 4);
  EXPECT_EQ(pixels["PhysicalSizeZ"], 10) << "the commanded step";
  EXPECT_EQ(pixels["PhysicalSizeXUnit"], "µm");
  EXPECT_EQ(pixels["Plane"][1]["TheZ"], 1);
  EXPECT_EQ(pixels["Plane"][1]["PositionZ"], 20.125) << "the measured place";
  EXPECT_EQ(pixels["Plane"][1]["PositionZUnit"], "µm");
  EXPECT_EQ(pixels["Plane"][1]["ExposureTime"], 750);
  EXPECT_EQ(pixels["Plane"][1]["ExposureTimeUnit"], "µs");
}

TEST(FvdctlExportSlices, LeavesOutWhatIsNotKnownAndTakesThePitchThatIsGiven) {
  ResultData data = test::sample_result();
  data.pixel_pitch_x_um = data.pixel_pitch_y_um = std::nullopt;
  const KeptJob job(PixelFormat::kMono8, std::move(data));

  ASSERT_EQ(job.exported().code, ctl::kExitOk);
  EXPECT_FALSE(find_slices(job.file()).pixel_pitch_x_um.has_value());
  fs::remove(job.file());
  ASSERT_EQ(job.exported({"--pitch-um", "0.5"}).code, ctl::kExitOk);

  EXPECT_EQ(find_slices(job.file()).pixel_pitch_y_um, 0.5);
}

TEST(FvdctlExportSlices, SaysHowToKeepSlicesWhereThereAreNone) {
  const KeptJob job;
  fs::remove_all(job.scratch / "job" / "slices");

  const auto outcome = job.exported();

  EXPECT_EQ(outcome.code, ctl::kExitBadData);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("no recorded slices"), HasSubstr("\"keep\": {\"slices\": true}")));
  EXPECT_FALSE(fs::exists(job.file()));
}

TEST(FvdctlExportSlices, RefusesDamagedSlicesAndLeavesNoFile) {
  const auto expect_refused = [](const KeptJob& job, const std::vector<const char*>& words) {
    const auto outcome = job.exported();
    EXPECT_EQ(outcome.code, ctl::kExitBadData) << outcome.err;
    for (const char* word : words) EXPECT_THAT(outcome.err, HasSubstr(word));
    EXPECT_FALSE(fs::exists(job.file()));
  };
  {
    const KeptJob job;
    fs::resize_file(job.slice(1), fs::file_size(job.slice(1)) - 1);
    expect_refused(job, {"slice_00001.pgm", "it ends after"});
  }
  {
    const KeptJob job;
    fs::remove(job.slice(2));
    expect_refused(job, {"slice_00002.pgm", "cannot be opened"});
  }
  {
    const KeptJob job;
    test::write_text(job.slice(1), pgm(1, PixelFormat::kMono8));
    expect_refused(job, {"slice_00001.pgm", "5 x 3", "all must be equal"});
  }
  {
    const KeptJob job;
    test::write_text(job.slice(3), pgm(3, PixelFormat::kMono12));
    expect_refused(job, {"z.txt tells 3 heights", "slice_00003.pgm"});
  }
  {
    const KeptJob job;
    fs::remove(job.scratch / "job/slices/z.txt");
    expect_refused(job, {"z.txt"});
  }
  {
    const KeptJob job;
    test::write_text(job.scratch / "job/slices/z.txt", "# nothing\n");
    expect_refused(job, {"z.txt"});
  }
  {
    const KeptJob job;
    test::write_text(job.scratch / "job/result.json", "{}");
    expect_refused(job, {"result.json"});
  }
}

TEST(FvdctlExportSlices, DoesNotTouchAFileThatIsThere) {
  const KeptJob job;
  test::write_text(job.file(), "mine");

  const auto outcome = job.exported();

  EXPECT_EQ(outcome.code, ctl::kExitIo);
  EXPECT_THAT(outcome.err, HasSubstr("stack.ome.tif"));
  EXPECT_EQ(test::read_text(job.file()), "mine");
}

TEST(FvdctlExportSlices, WantsTheFolderOfAJob) {
  const KeptJob job;
  const auto outcome = run_command(
      {"export", (job.scratch / "job/height.tiff").string(), "--format", "ome-tiff", "--out", job.file().string()});

  EXPECT_EQ(outcome.code, ctl::kExitBadData);
  EXPECT_THAT(outcome.err, HasSubstr("no folder of a result"));
}

}  // namespace
}  // namespace fvd
