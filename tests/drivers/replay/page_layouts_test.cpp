/// Families of names and layouts of pages as people have them: each with its order, its z, and what is left out.

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "drivers/replay/slice_files.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/tiff_writer.hpp"

namespace fvd {
namespace {

using Names = std::vector<std::string>;

cv::Mat page(int level, int size = 8) { return {size, size, CV_8UC1, cv::Scalar(level)}; }

std::vector<test::TiffPageSpec> pages(int count, const std::string& description = {}) {
  std::vector<test::TiffPageSpec> specs;
  for (int i = 0; i < count; ++i) specs.push_back({page(i), i == 0 ? description : "", 0, 0});
  return specs;
}

std::string ome(const std::string& attributes, const std::string& inside) {
  return "<?xml version=\"1.0\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image><Pixels "
         "SizeX=\"8\" SizeY=\"8\" Type=\"uint8\" " +
         attributes + ">" + inside + "</Pixels></Image></OME>";
}

/// Pages of one TIFF, and the pages (from 1) that must be the slices in order.
struct Layout {
  std::string title;
  std::vector<test::TiffPageSpec> specs;
  std::vector<int> order;  ///< empty: a question
  std::vector<double> z_um;
  Names question;
  StackChoice choice;
};

std::vector<Layout> described_layouts() {
  const std::string two = "ImageJ=1.53t\nimages=6\nchannels=2\nslices=3\nhyperstack=true\nspacing=2.5\nunit=micron\n";
  const std::string cz =
      ome("DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"2\" SizeT=\"1\" PhysicalSizeZ=\"0.01\" "
          "PhysicalSizeZUnit=\"mm\"",
          "<Channel Name=\"DAPI\"/><Channel Name=\"GFP\"/><TiffData/>");
  const std::string reversed =
      ome("DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\"",
          "<Channel/><TiffData IFD=\"0\" FirstZ=\"2\"/><TiffData IFD=\"1\" FirstZ=\"1\"/><TiffData IFD=\"2\"/>");
  const std::string positions =
      ome("DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\" PhysicalSizeZ=\"1\"",
          "<TiffData/><Plane TheZ=\"0\" TheC=\"0\" TheT=\"0\" PositionZ=\"30\" PositionZUnit=\"\xC2\xB5m\"/><Plane "
          "TheZ=\"1\" TheC=\"0\" TheT=\"0\" PositionZ=\"20\" PositionZUnit=\"\xC2\xB5m\"/><Plane TheZ=\"2\" TheC=\"0\" "
          "TheT=\"0\" PositionZ=\"12\" PositionZUnit=\"\xC2\xB5m\"/>");
  const std::string triple = ome("DimensionOrder=\"XYCZT\" SizeZ=\"3\" SizeC=\"3\" SizeT=\"1\"",
                                 "<Channel SamplesPerPixel=\"3\"/><TiffData/>");
  std::vector<test::TiffPageSpec> colour = pages(3, triple);
  for (auto& spec : colour) spec.pixels = cv::Mat(8, 8, CV_8UC3, cv::Scalar(1, 2, 3));
  return {{"ImageJ, two channels", pages(6, two), {}, {}, {"channel", "--channel", "1 to 2"}, {}},
          {"ImageJ, the second channel", pages(6, two), {2, 4, 6}, {0, 2.5, 5}, {}, {"", 2, {}}},
          {"ImageJ, no such channel", pages(6, two), {}, {}, {"no channel 3", "1 to 2"}, {"", 3, {}}},
          {"ImageJ, one channel",
           pages(3, "ImageJ=1.53t\nimages=3\nslices=3\nspacing=0.5\nunit=\\u00B5m\n"),
           {1, 2, 3},
           {0, 0.5, 1},
           {},
           {}},
          {"ImageJ, pixels as the unit",
           pages(3, "ImageJ=1.53t\nimages=3\nslices=3\nspacing=1.0\nunit=pixel\n"),
           {1, 2, 3},
           {},
           {},
           {}},
          {"ImageJ, times",
           pages(6, "ImageJ=1.53t\nimages=6\nslices=3\nframes=2\nspacing=1\nunit=um\n"),
           {},
           {},
           {"time", "--time", "1 to 2"},
           {}},
          {"ImageJ, the second time",
           pages(6, "ImageJ=1.53t\nimages=6\nslices=3\nframes=2\nspacing=1\nunit=um\n"),
           {4, 5, 6},
           {0, 1, 2},
           {},
           {"", {}, 2}},
          {"ImageJ, slices that are called times",
           pages(4, "ImageJ=1.53t\nimages=4\nframes=4\n"),
           {1, 2, 3, 4},
           {},
           {},
           {}},
          {"OME, two channels", pages(6, cz), {}, {}, {"1 DAPI, 2 GFP", "--channel"}, {}},
          {"OME, the second channel", pages(6, cz), {4, 5, 6}, {0, 10, 20}, {}, {"", 2, {}}},
          {"OME, pages in another order", pages(3, reversed), {3, 2, 1}, {}, {}, {}},
          {"OME, positions that fall", pages(3, positions), {1, 2, 3}, {30, 20, 12}, {}, {}},
          {"OME, a colour triple", colour, {1, 2, 3}, {}, {}, {}},
          {"OME, pages that are not there", pages(5, cz), {}, {}, {"page 6", "incomplete"}, {"", 2, {}}},
          {"OME that is damaged", pages(3, "<?xml version=\"1.0\"?><OME><Image>"), {}, {}, {"well-formed"}, {}}};
}

std::vector<Layout> plain_layouts() {
  std::vector<test::TiffPageSpec> reduced = pages(3);
  reduced.push_back({page(0, 2), "", FILETYPE_REDUCEDIMAGE, 0});
  std::vector<test::TiffPageSpec> first = pages(3);
  first.insert(first.begin(), {page(0, 2), "", FILETYPE_REDUCEDIMAGE, 0});
  std::vector<test::TiffPageSpec> mask = pages(3);
  mask.push_back({page(0), "", FILETYPE_MASK, 0});
  std::vector<test::TiffPageSpec> documents = pages(3);
  for (auto& spec : documents) spec.subfile_type = FILETYPE_PAGE;
  return {{"plain pages", pages(4), {1, 2, 3, 4}, {}, {}, {}},
          {"a reduced page last", reduced, {1, 2, 3}, {}, {}, {}},
          {"a reduced page first", first, {2, 3, 4}, {}, {}, {}},
          {"a mask", mask, {1, 2, 3}, {}, {}, {}},
          {"pages of a document", documents, {1, 2, 3}, {}, {}, {}},
          {"a channel of plain pages", pages(4), {}, {}, {"does not tell of channels"}, {"", 2, {}}}};
}

/// What came of one row of the table.
struct Score {
  int rows = 0;
  int right = 0;
  int silently_dropped = 0;

  void add(const std::string& title, const std::string& fault) {
    ++rows;
    if (fault.empty()) {
      ++right;
    } else {
      ADD_FAILURE() << title << ": " << fault;
    }
  }
};

std::string fault_of_question(const Error& error, const Names& words) {
  if (words.empty()) return std::string("is refused: ") + error.what();
  if (error.code() != ErrorCode::kBadInput) return "is refused with another code";
  for (const std::string& word : words) {
    if (std::string(error.what()).find(word) == std::string::npos) return "lacks '" + word + "': " + error.what();
  }
  return {};
}

bool equal_z(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return std::abs(x - y) < 1e-9; });
}

std::string fault_of(const Layout& row, const std::filesystem::path& file, Score& score) {
  SliceList list;
  try {
    list = find_slices(file, row.choice);
  } catch (const Error& error) {
    return fault_of_question(error, row.question);
  }
  const int used_and_ignored = list.used_pages + static_cast<int>(list.ignored_pages.size());
  score.silently_dropped += static_cast<int>(row.specs.size()) - used_and_ignored;
  if (!row.question.empty()) return "was taken as " + list.description;
  std::vector<int> order;
  for (const SliceLocation& slice : list.slices) order.push_back(*slice.page + 1);
  if (order != row.order) return "has other pages: " + testing::PrintToString(order);
  if (!equal_z(list.z_um, row.z_um)) return "has another z: " + testing::PrintToString(list.z_um);
  if (list.used_pages != static_cast<int>(list.slices.size())) return "counts " + std::to_string(list.used_pages);
  return {};
}

TEST(PageLayouts, TellThePitchOfPixelsWhereTheirDescriptionDoes) {
  const test::ScratchDir scratch;
  const auto slices = [&](const std::string& attributes) {
    test::write_tiff(
        scratch / "s.tif",
        pages(3, ome("DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\" " + attributes, "<TiffData/>")));
    return find_slices(scratch / "s.tif");
  };
  const SliceList told = slices("PhysicalSizeX=\"2.5\" PhysicalSizeY=\"0.0026\" PhysicalSizeYUnit=\"mm\"");
  EXPECT_DOUBLE_EQ(told.pixel_pitch_x_um.value_or(0.0), 2.5);
  EXPECT_DOUBLE_EQ(told.pixel_pitch_y_um.value_or(0.0), 2.6);
  EXPECT_FALSE(slices("PhysicalSizeX=\"2.5\"").pixel_pitch_x_um) << "of one side alone";
  EXPECT_FALSE(slices("PhysicalSizeX=\"2\" PhysicalSizeXUnit=\"pixel\" PhysicalSizeY=\"2\"").pixel_pitch_y_um);
}

TEST(PageLayouts, AreAllRightAndNothingIsDroppedSilently) {
  Score score;
  for (const auto& table : {described_layouts(), plain_layouts()}) {
    for (const Layout& row : table) {
      const test::ScratchDir scratch;
      test::write_tiff(scratch / "stack.tif", row.specs);
      score.add(row.title, fault_of(row, scratch / "stack.tif", score));
    }
  }
  EXPECT_GE(score.rows, 20);
  EXPECT_EQ(score.silently_dropped, 0);
  std::cout << "{\"layouts\": " << score.rows << ", \"layouts_right\": " << score.right
            << ", \"silently_dropped\": " << score.silently_dropped << "}" << std::endl;
}

}  // namespace
}  // namespace fvd
