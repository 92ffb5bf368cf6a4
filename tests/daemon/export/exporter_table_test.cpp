#include "daemon/export/exporter_table.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "daemon/export/result_writer.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;
using testing::ElementsAreArray;

ResultData result_with_extra_map() {
  ResultData data = test::sample_result();
  data.extra_maps.emplace_back(PeakMethod::kNearest, test::sample_map(7, 2));
  data.smoothed.emplace();
  data.smoothed->height_m = Plane<float>(6, 3);
  data.smoothed->sigma_m = Plane<float>(6, 3);
  data.repeated = RepeatedScans{2, Plane<float>(6, 3), 0.25};
  data.evaluation = test::sample_measurements();
  return data;
}

/// The file that a row makes of result_with_extra_map().
std::string file_of(const Exporter& exporter) {
  std::string name(exporter.name);
  if (exporter.need == ExportNeed::kEachExtraMap) name.replace(name.find('*'), 1, "nearest");
  if (exporter.need == ExportNeed::kEachSection) name.replace(name.find('*'), 1, "step");
  return name;
}

void write_with(const std::filesystem::path& target, std::span<const Exporter> exporters) {
  AtomicDirectory directory(target);
  write_result(directory, result_with_extra_map(), exporters);
  directory.commit();
}

TEST(ExporterTable, HasOneNameARow) {
  std::set<std::string_view> names;
  for (const Exporter& exporter : exporter_table()) {
    EXPECT_TRUE(names.insert(exporter.name).second) << exporter.name;
    const bool many = exporter.need == ExportNeed::kEachExtraMap || exporter.need == ExportNeed::kEachSection;
    EXPECT_EQ(many, exporter.name.find('*') != std::string_view::npos) << exporter.name;
  }
}

TEST(ExporterTable, GivesTheRowsThatARecipeNames) {
  const auto names_of = [](const std::vector<Exporter>& exporters) {
    std::vector<std::string> names;
    for (const Exporter& exporter : exporters) names.emplace_back(exporter.name);
    return names;
  };
  EXPECT_THAT(
      names_of(chosen_exporters(std::nullopt)),
      testing::AllOf(testing::Contains("height.gsf"), testing::Contains("mask.png"),
                     testing::Not(testing::Contains("sigma.gsf")), testing::Not(testing::Contains("height.x3p"))))
      << "some are made on request only";
  EXPECT_EQ(names_of(chosen_exporters({{"x3p", "gsf"}})),
            (std::vector<std::string>{"repeat_sd.gsf", "height.gsf", "sigma.gsf", "height.x3p"}));
  EXPECT_EQ(names_of(chosen_exporters({{"mask.png", "height.tiff", "none.txt"}})),
            (std::vector<std::string>{"height.tiff", "mask.png"}));
  EXPECT_TRUE(chosen_exporters(std::vector<std::string>{}).empty());

  const ScratchDir scratch;
  write_with(scratch / "few", chosen_exporters({{"mask.png"}}));
  EXPECT_TRUE(std::filesystem::exists(scratch / "few" / "mask.png"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "few" / "result.json"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "few" / "height.tiff"));
}

std::vector<std::string> first_of(const std::vector<std::string>& names) {
  std::vector<std::string> first;
  for (const Exporter& exporter : divided(chosen_exporters(names)).first) first.emplace_back(exporter.name);
  return first;
}

TEST(ExporterTable, LetsAFileFollowWhereAllThatItIsMadeOfIsWrittenFirst) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(first_of({"height.tiff", "height.x3p", "preview.png"}), (Names{"height.tiff"}));
  EXPECT_EQ(first_of({"height.x3p", "height.sdf", "report.pdf"}), (Names{"height.x3p"}))
      << "one that holds the heights comes first where there is no height.tiff";
  EXPECT_EQ(first_of({"height.gsf", "sigma.gsf", "sigma.png"}), (Names{"height.gsf", "sigma.gsf"}));
  EXPECT_EQ(first_of({"preview.png"}), (Names{"preview.png"})) << "nothing would hold the heights";
  EXPECT_EQ(first_of({"height.tiff", "holes.png", "height.ply"}), (Names{"height.tiff", "height.ply", "holes.png"}))
      << "neither mask nor image would be there";
  EXPECT_EQ(divided(chosen_exporters(std::nullopt)).following.size(), 5U)
      << "height.gsf, preview.png, texture_view.png, profile_*.png and edge.png";
}

TEST(ExporterTable, KnowsOfEveryRowThatFollowsWhatItReads) {
  for (const Exporter& exporter : exporter_table()) {
    const bool follows = exporter.time == ExportTime::kFollows;
    EXPECT_EQ(exporter.reads != 0, follows) << exporter.name;
    const bool of_memory = exporter.need == ExportNeed::kSmoothedMap || exporter.need == ExportNeed::kEachExtraMap;
    EXPECT_FALSE(follows && of_memory) << exporter.name;
  }
}

TEST(ExporterTable, GivesTheBytesThatTheDirectoryHolds) {
  const ScratchDir scratch;
  const ResultData data = result_with_extra_map();
  write_with(scratch / "job", exporter_table());
  const ExportInput of_result = export_input(data);
  std::vector<std::string> names;
  for (const Exporter& exporter : exporter_table()) {
    for (const ExportFile& file : export_files(exporter, of_result)) {
      names.push_back(file.name);
      const std::string written = test::read_text(scratch / ("job/" + file.name));
      EXPECT_FALSE(written.empty()) << exporter.name;
      EXPECT_TRUE(written == bytes_of(exporter, file.input)) << exporter.name;
    }
  }
  std::vector<std::string> listed;
  const auto json = nlohmann::json::parse(test::read_text(scratch / "job/result.json"));
  for (const auto& file : json["files"]) listed.push_back(file["name"]);
  EXPECT_THAT(listed, ElementsAreArray(names)) << "in the order of the table, whatever was done first";
}

TEST(ExporterTable, FailsTheResultWithTheNameOfTheRowThatFailed) {
  for (std::size_t broken = 0; broken < exporter_table().size(); ++broken) {
    const ScratchDir scratch;
    // Beside one that does not fail.
    std::array exporters{exporter_table()[(broken + 1) % exporter_table().size()], exporter_table()[broken]};
    exporters[1].stream = nullptr;
    exporters[1].encode = [](const ExportInput&) -> std::string {
      throw Error(ErrorCode::kStorageFull, "No space left");
    };
    test::expect_error(ErrorCode::kStorageFull, {file_of(exporters[1]), "No space left"},
                       [&] { write_with(scratch / "job", exporters); });
    EXPECT_THAT(scratch.entries(), testing::IsEmpty()) << exporters[1].name;
  }
}

TEST(ExporterTable, NamesTheRowAlsoForAnExceptionOfALibrary) {
  const ScratchDir scratch;
  const std::array exporters{Exporter{"odd.bin", ExportNeed::kResult, ExportCost::kQuick,
                                      [](const ExportInput&) -> std::string { throw std::length_error("too long"); }}};
  test::expect_error(ErrorCode::kInternal, {"odd.bin", "too long"}, [&] { write_with(scratch / "job", exporters); });
}

TEST(ExporterTable, RefusesTwoRowsOfOneName) {
  const ScratchDir scratch;
  const Exporter row{"a.bin", ExportNeed::kResult, ExportCost::kQuick,
                     [](const ExportInput&) { return std::string("a"); }};
  const std::array exporters{row, row};
  test::expect_error(ErrorCode::kStorageWrite, {"a.bin", "exists"}, [&] { write_with(scratch / "job", exporters); });
}

/// Exporters that see how many of them run.
struct Meeting {
  std::atomic<int> running{0};
  std::atomic<int> most{0};
  std::promise<void> second_came;
  std::shared_future<void> met{second_came.get_future()};
};
Meeting* meeting = nullptr;

std::string meet(const ExportInput& /*input*/) {
  const int now = ++meeting->running;
  if (now == 2 && meeting->most.exchange(2) < 2) meeting->second_came.set_value();
  if (now > 2) meeting->most = now;
  meeting->met.wait_for(std::chrono::seconds(20));  // ends at once where two run side by side
  --meeting->running;
  return "x";
}

TEST(ExporterTable, RunsTwoExportersSideBySideAndNeverThree) {
  const ScratchDir scratch;
  Meeting here;
  meeting = &here;
  using enum ExportNeed;
  const std::array exporters{
      Exporter{"1", kResult, ExportCost::kQuick, meet}, Exporter{"2", kResult, ExportCost::kSlow, meet},
      Exporter{"3", kResult, ExportCost::kQuick, meet}, Exporter{"4", kResult, ExportCost::kQuick, meet}};
  write_with(scratch / "job", exporters);
  EXPECT_EQ(here.most, 2);
}

}  // namespace
}  // namespace fvd
